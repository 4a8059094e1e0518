// The baseline of the pair kernels: weights alone, 6 points a triangle, compiled for the machine it runs on. Its two
// headers are not part of this project.
#include "pairs.hpp"
#include "mortar_quad4.hpp"
#include <cstring>

extern "C" void baseline_pairs(int n, double *coordinates)
{
  const auto pairs = make_pairs(n);
  std::memcpy(coordinates, pairs.data(), n * sizeof(Pair));
}

extern "C" double baseline_pass(int n, const double *coordinates)
{
  const TriRule rule = {6, R6};
  double        sum  = 0;
  for (int k = 0; k < n; k++) {
    Mortar weights;
    if (mortar_pair(coordinates + 24 * k, coordinates + 24 * k + 12, rule, weights)) sum += weights.D[0][1];
    __asm__ volatile("" : : "r"(&weights) : "memory"); // all of them are wanted
  }
  return sum;
}
