/* Stage 4: the node's own row and block, scaled, in both layouts. */
#include "check.h"

int main(void) {
  stickslip_node_response r;
  double row[3], block[9];
  memset(&r, 0, sizeof r);
  r.struct_size = sizeof r;
  for (int i = 0; i < 3; ++i) r.row[i] = 1.0 + i;
  for (int i = 0; i < 9; ++i) r.drow_dlambda[i] = -1.0 - i;

  for (int32_t layout = 0; layout < 2; ++layout) {
    CHECK_OK(stickslip_node_block(&r, 2.0, layout, row, block));
    for (int i = 0; i < 3; ++i) {
      CHECK(row[i] == 2.0 * r.row[i]);
      for (int j = 0; j < 3; ++j) {
        const int at = layout == STICKSLIP_LAYOUT_ROW_MAJOR ? 3 * i + j : 3 * j + i;
        CHECK(block[at] == 2.0 * r.drow_dlambda[3 * i + j]);
      }
    }
  }

  /* Either output alone, or none. */
  CHECK_OK(stickslip_node_block(&r, 1.0, 0, row, NULL));
  CHECK_OK(stickslip_node_block(&r, 1.0, 0, NULL, block));
  CHECK_OK(stickslip_node_block(&r, 1.0, 0, NULL, NULL));
  CHECK(row[0] == 1.0 && block[0] == -1.0);

  FILL(row);
  FILL(block);
  CHECK_REFUSED(stickslip_node_block(&r, 1.0, 2, row, block), STICKSLIP_INVALID_VALUE, "layout");
  CHECK_REFUSED(stickslip_node_block(&r, 1.0, -1, row, block), STICKSLIP_INVALID_VALUE, "layout");
  CHECK_REFUSED(stickslip_node_block(&r, INFINITY, 0, row, block), STICKSLIP_NOT_FINITE, "scale");
  CHECK_UNTOUCHED(row);
  CHECK_UNTOUCHED(block);
  return 0;
}
