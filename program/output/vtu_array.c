/* Arrays of a VTU file, as text. */
#include "output/output.h"

/* VTK's number of a kind of cell */
int vtu_type(CellKind kind)
{
  static const int types[CELL_KINDS] = {
      [LINE2] = 3, [LINE3] = 21, /* VTK_LINE, VTK_QUADRATIC_EDGE */
      [TRI3] = 5,  [TRI6] = 22,  /* VTK_TRIANGLE, VTK_QUADRATIC_TRIANGLE */
      [QUAD4] = 9, [QUAD8] = 23, [QUAD9] = 28, /* VTK_QUAD, VTK_QUADRATIC_QUAD, VTK_BIQUADRATIC_QUAD */
      [TET4] = 10, [TET10] = 24, /* VTK_TETRA, VTK_QUADRATIC_TETRA */
      [HEX8] = 12, [HEX20] = 25, [HEX27] = 29, /* VTK_HEXAHEDRON, VTK_QUADRATIC_, VTK_TRIQUADRATIC_HEXAHEDRON */
  };
  return types[kind];
}

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
