/* Both libraries are there and go together: shares that are missing are refused, in words. */
#include <stdio.h>
#include <stickslip_mpi.h>

int main(int argc, char **argv) {
  stickslip_options        options;
  stickslip_mpi_interface *interface = NULL;
  MPI_Init(&argc, &argv);
  stickslip_options_init(&options, sizeof options);
  const int32_t status = stickslip_mpi_interface_create(MPI_COMM_WORLD, NULL, NULL, &options, NULL, &interface);
  printf("%s\n", stickslip_mpi_last_error_message());
  MPI_Finalize();
  return status != STICKSLIP_NULL_POINTER;
}
