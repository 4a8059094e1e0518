/* Nodes that three interfaces share. */
#include "check.h"

/* Node 5 twice in one list: a node on a crease is one node. */
static const int64_t offsets1[4] = {0, 5, 7, 10}, nodes1[10] = {9, 5, 5, 1, 3, 9, 7, 30, 9, -4};
static const int64_t offsets2[4] = {0, 3, 6, 9}, nodes2[9] = {20, 21, 3, 1, 20, 21, 7, 9, 20};

static void found(void) {
  int64_t count = -1, nodes[5] = {0}, claims[5] = {0};
  int32_t kinds[5] = {0};
  CHECK_OK(stickslip_crosspoints_find(3, offsets1, nodes1, offsets2, nodes2, 0, NULL, NULL, NULL, &count));
  CHECK(count == 4);
  CHECK_OK(stickslip_crosspoints_find(3, offsets1, nodes1, offsets2, nodes2, 4, nodes, kinds, claims, &count));
  const int64_t expected[5] = {1, 3, 7, 9, 0}, times[5] = {1, 1, 1, 3, 0};
  CHECK(memcmp(nodes, expected, sizeof nodes) == 0 && memcmp(claims, times, sizeof claims) == 0);
  CHECK(kinds[0] == STICKSLIP_CROSSPOINT_CHAIN && kinds[1] == STICKSLIP_CROSSPOINT_BOTH_SIDES);
  CHECK(kinds[2] == STICKSLIP_CROSSPOINT_CHAIN);
  CHECK(kinds[3] ==
        (STICKSLIP_CROSSPOINT_CLAIMED | STICKSLIP_CROSSPOINT_CHAIN | STICKSLIP_CROSSPOINT_BOTH_SIDES));
  /* One interface whose sides share nothing; its mortar side may be empty, as an analytic one is. */
  const int64_t nothing[2] = {0, 0};
  CHECK_OK(stickslip_crosspoints_find(1, offsets1, nodes1, nothing, NULL, 0, NULL, NULL, NULL, &count));
  CHECK(count == 0);
}

static void refusals(void) {
  int64_t count, nodes[4], claims[4];
  int32_t kinds[4];
  FILL(count);
  FILL(nodes);
  FILL(claims);
  FILL(kinds);
  CHECK_REFUSED(stickslip_crosspoints_find(0, offsets1, nodes1, offsets2, nodes2, 4, nodes, kinds, claims, &count),
                STICKSLIP_INVALID_SIZE, "n_interfaces");
  CHECK_REFUSED(stickslip_crosspoints_find(3, NULL, nodes1, offsets2, nodes2, 4, nodes, kinds, claims, &count),
                STICKSLIP_NULL_POINTER, "nonmortar_offsets");
  CHECK_REFUSED(stickslip_crosspoints_find(3, offsets1, NULL, offsets2, nodes2, 4, nodes, kinds, claims, &count),
                STICKSLIP_NULL_POINTER, "nonmortar_nodes");
  CHECK_REFUSED(stickslip_crosspoints_find(3, offsets1, nodes1, NULL, nodes2, 4, nodes, kinds, claims, &count),
                STICKSLIP_NULL_POINTER, "mortar_offsets");
  CHECK_REFUSED(stickslip_crosspoints_find(3, offsets1, nodes1, offsets2, NULL, 4, nodes, kinds, claims, &count),
                STICKSLIP_NULL_POINTER, "mortar_nodes");
  CHECK_REFUSED(stickslip_crosspoints_find(3, offsets1, nodes1, offsets2, nodes2, 4, nodes, NULL, claims, &count),
                STICKSLIP_NULL_POINTER, "kinds");
  CHECK_REFUSED(stickslip_crosspoints_find(3, offsets1, nodes1, offsets2, nodes2, 3, nodes, kinds, claims, &count),
                STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  CHECK_REFUSED(stickslip_crosspoints_find(3, offsets1, nodes1, offsets2, nodes2, 4, nodes, kinds, claims, NULL),
                STICKSLIP_NULL_POINTER, "count");
  const int64_t late[4] = {1, 5, 7, 10}, falling[4] = {0, 5, 4, 10};
  CHECK_REFUSED(stickslip_crosspoints_find(3, late, nodes1, offsets2, nodes2, 4, nodes, kinds, claims, &count),
                STICKSLIP_INVALID_SIZE, "nonmortar_offsets[0]");
  CHECK_REFUSED(stickslip_crosspoints_find(3, offsets1, nodes1, falling, nodes2, 4, nodes, kinds, claims, &count),
                STICKSLIP_INVALID_SIZE, "mortar_offsets[2]");
  CHECK_UNTOUCHED(count);
  CHECK_UNTOUCHED(nodes);
  CHECK_UNTOUCHED(claims);
  CHECK_UNTOUCHED(kinds);
}

int main(void) {
  found();
  refusals();
  return 0;
}
