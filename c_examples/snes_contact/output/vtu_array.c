/* Arrays of a VTU file, as text. */
#include "output/output.h"

void vtu_start_array(FILE *file, const char *type, const char *name, int components)
{
  fprintf(file, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"ascii\">\n", type, name,
          components);
}

void vtu_end_array(FILE *file)
{
  fprintf(file, "</DataArray>\n");
}

/* One per node, with all digits: 17 give the same number back. */
void vtu_vectors(FILE *file, const char *name, PetscInt n, const PetscScalar *values)
{
  vtu_start_array(file, "Float64", name, 3);
  for (PetscInt k = 0; k < n; k++)
    fprintf(file, "%.17g %.17g %.17g\n", PetscRealPart(values[3 * k]), PetscRealPart(values[3 * k + 1]),
            PetscRealPart(values[3 * k + 2]));
  vtu_end_array(file);
}

void vtu_declare(FILE *file, const char *type, const char *name, int components)
{
  fprintf(file, "<PDataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\"/>\n", type, name, components);
}
