// A C++ program that finds the installed library: one pair of facets.
#include <array>
#include <cmath>
#include <cstdio>

#include <stickslip.h>

int main() {
  const std::array<double, 9> lower{0, 0, 0, 1, 0, 0, 0, 1, 0}, upper{0, 0, 0.5, 0, 1, 0.5, 1, 0, 0.5};
  stickslip_pair pair{};
  pair.struct_size = sizeof pair;
  pair.n1 = pair.n2 = 3;
  pair.x1 = upper.data();
  pair.x2 = lower.data();
  std::array<double, 9> n_ab, n_ac;
  if (stickslip_pair_weights(&pair, n_ab.data(), n_ac.data(), nullptr, nullptr) != STICKSLIP_OK) {
    std::puts(stickslip_last_error_message());
    return 1;
  }
  double area = 0;
  for (const double w : n_ac) area += w;
  std::printf("overlap %.3f with stickslip %s\n", area, stickslip_version());
  return std::fabs(area - 0.5) < 1e-14 ? 0 : 1;
}
