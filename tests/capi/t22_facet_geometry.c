/* A facet's share of nodal normals and areas, and the nodal normal made of the shares. */
#include "pair.h"

int main(void) {
  double normals[12], areas[4], nu[3];

  CHECK_OK(stickslip_facet_geometry(4, quad1, normals, areas));
  for (int k = 0; k < 4; ++k) {
    CHECK(normals[3 * k] == 0.0 && normals[3 * k + 1] == 0.0 && normals[3 * k + 2] == -1.0);
    CHECK_NEAR(areas[k], 0.25, 1e-16);
  }
  CHECK_OK(stickslip_facet_geometry(3, tri1, normals, areas));
  for (int k = 0; k < 3; ++k) CHECK_NEAR(areas[k], 1.0 / 6.0, 1e-16);

  /* Each output alone, and none. */
  CHECK_OK(stickslip_facet_geometry(3, tri1, normals, NULL));
  CHECK_OK(stickslip_facet_geometry(3, tri1, NULL, areas));
  CHECK_OK(stickslip_facet_geometry(3, tri1, NULL, NULL));

  /* Two facets at a right angle: the normal in between, into the body. */
  const double sum[3] = {1.0, 0.0, 1.0};
  CHECK_OK(stickslip_node_normal(sum, nu));
  CHECK_NEAR(nu[0], -sqrt(0.5), 2e-16);
  CHECK_NEAR(nu[2], -sqrt(0.5), 2e-16);

  const double cancelled[3] = {1e-9, 0.0, -1e-9};
  FILL(nu);
  CHECK_REFUSED(stickslip_node_normal(cancelled, nu), STICKSLIP_UNDEFINED_NORMAL, "normals");
  CHECK_UNTOUCHED(nu);

  /* A sum whose length overflows has no normal; it used to come out as 0. */
  const double endless[3] = {1e300, 0.0, 1e300};
  CHECK_REFUSED(stickslip_node_normal(endless, nu), STICKSLIP_NOT_FINITE, "normals");
  CHECK_UNTOUCHED(nu);
  return 0;
}
