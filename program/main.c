/* stickslip: frictional contact of elastic bodies, solved by PETSc's SNES with the stickslip contact element.
 *
 *   stickslip FILE.yaml [-output_dir DIR] [any PETSc option]
 *
 * -scene FILE.yaml names the scene, too. Without a folder the results go to FILE_results in the current one.
 *
 * The scene's format is documented in c_examples/scenes/README.md. Exit codes: 0 every step converged, 1 bad scene, 2 not converged,
 * 3 refused by the contact library. */
#include "mesh/converted.h"
#include "physics/dynamics.h"
#include "model.h"
#include "scene/keys_print.h"
#include "solve/sensitivity.h"
#include <stddef.h>
#include <stdio.h>
#include <string.h>

static const char help[] = "Frictional contact of elastic bodies.\n"
                           "  FILE.yaml, or -scene FILE.yaml   what to solve (format: c_examples/scenes/README.md)\n"
                           "  -output_dir DIR    where summary.json, interface_*.csv and step_*.vtu go; else to FILE_results\n"
                           "  -convert FILE.h5   writes the bodies from Gmsh files for all ranks to read, and ends\n"
                           "  -keys [ITEM]       prints the keys of a scene, or of one item of it as `interfaces`, and ends\n"
                           "  -test_jacobian_blocks  compare the tangent with differences of the residual\n"
                           "Every value of the scene can be overridden: `block: {young: 1}` by -block_young 1.\n\n";

/* Each room knows those below it: mesh, physics, contact, solve, heat, output. */
static void connect(Model *model)
{
  model->physics.mesh    = &model->mesh;
  model->contact.mesh    = &model->mesh;
  model->contact.physics = &model->physics;
  model->solve.mesh      = &model->mesh;
  model->solve.physics   = &model->physics;
  model->solve.contact   = &model->contact;
  model->heat.mesh       = &model->mesh;
  model->heat.physics    = &model->physics;
  model->heat.contact    = &model->contact;
  model->output.mesh     = &model->mesh;
  model->output.physics  = &model->physics;
  model->output.contact  = &model->contact;
  model->output.solve    = &model->solve;
  model->output.heat     = &model->heat;
}

static PetscErrorCode read_scene(Model *model)
{
  PetscReal schema = 0;
  PetscFunctionBegin;
  scene_check_maps(model->scene);
  if (!scene_has(model->scene, NULL, "schema"))
    scene_fail(model->scene, NULL, "schema", "this key is missing: begin the file with `schema: 1`.");
  scene_real_required(model->scene, NULL, "schema", &schema);
  if (schema != 1) scene_fail(model->scene, NULL, "schema", "this program reads schema 1, not %g.", (double)schema);
  PetscCall(mesh_create(model->scene, &model->mesh));
  PetscCall(materials_read(model->scene, &model->physics));
  PetscCall(rigids_read(model->scene, &model->physics));
  PetscCall(times_read(model->scene, &model->solve.steps));
  model->physics.end = model->solve.steps.end;
  PetscCall(supports_read(model->scene, &model->physics));
  PetscCall(loads_read(model->scene, &model->physics));
  PetscCall(dynamics_read(model->scene, &model->physics));
  PetscCall(springs_read(model->scene, &model->physics));
  PetscCall(contact_read(model->scene, &model->contact));
  PetscCall(iterative_read(model->scene, &model->solve));
  PetscCall(heat_read(model->scene, &model->heat));
  PetscCall(sensitivity_read(model->scene, &model->solve));
  sensitivity_refuse(model->scene, &model->solve, model->heat.on, "heat");
  PetscCall(output_read(model->scene, &model->output));
  scene_string(model->scene, NULL, "restart", model->restart, sizeof(model->restart));
  model->solve.quiet = model->output.quiet;
  scene_root_begin(model->scene); /* rank 0 has read every key */
  if (model->mesh.rank == 0) scene_check_unread(model->scene, PETSC_FALSE);
  PetscCall(scene_root_end(model->scene));
  PetscCall(mesh_rotate(&model->mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From the scene to what Newton's method works on; `status` > 0: the library refused the interfaces. */
static PetscErrorCode build(Model *model, PetscInt *status)
{
  Physics *physics = &model->physics;
  Contact *contact = &model->contact;
  Solve   *solve   = &model->solve;
  Field   *fields;
  PetscInt n_redundant;

  PetscFunctionBegin;
  PetscCall(plex_create(&model->mesh));
  PetscCall(supports_label(physics));
  PetscCall(loads_label(physics));
  PetscCall(springs_label(physics));
  PetscCall(contact_label(contact));
  PetscCall(heat_label(&model->heat));
  PetscCall(parts_label(physics));
  PetscCall(reach_measure(contact));
  PetscCall(plex_distribute(&model->mesh));
  PetscCall(supports_file_move(physics));
  PetscCall(mesh_forget_pieces(&model->mesh));
  PetscCall(contact_fields(contact, &fields));
  PetscCall(unknowns_create(physics, contact->n_interfaces, fields));
  PetscCall(parts_create(physics));
  PetscCall(timed_create(physics));
  PetscCall(springs_create(model->scene, physics));
  PetscCall(held_create(solve));
  iterative_check(model->scene, solve);
  PetscCall(bulk_create(physics));
  PetscCall(loads_assemble(physics));
  PetscCall(heat_create(&model->heat));
  PetscCall(dynamics_create(model->scene, physics));
  PetscCall(contact_create(contact, model->scene, solve->quiet, status));
  if (*status) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(supports_values(physics, 0));
  PetscCall(VecCopy(physics->prescribed_local, physics->u_local)); /* the configuration of the first sparsity pattern */
  PetscCall(newton_create(solve));
  PetscCall(sensitivity_create(model->scene, solve));
  PetscCall(redundant_find(solve, NULL, &n_redundant));
  PetscCall(jacobian_test_create(solve, model->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode clean_up(Model *model)
{
  PetscFunctionBegin;
  PetscCall(output_destroy(&model->output));
  PetscCall(heat_destroy(&model->heat));
  PetscCall(sensitivity_destroy(&model->solve));
  PetscCall(newton_destroy(&model->solve));
  PetscCall(held_destroy(&model->solve));
  PetscCall(redundant_destroy(&model->solve));
  PetscCall(times_destroy(&model->solve.steps));
  PetscCall(contact_destroy(&model->contact));
  PetscCall(physics_destroy(&model->physics));
  PetscCall(mesh_destroy(&model->mesh));
  PetscCall(PetscFree(model->effective));
  PetscCall(scene_close(&model->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The scene's file: the first argument, unless it is an option. */
static PetscErrorCode find_scene(int argc, char **argv, char scene[], size_t length, PetscBool *found)
{
  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-scene", scene, length, found));
  if (*found || argc < 2 || argv[1][0] == '-') PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(scene, argv[1], length));
  *found = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `-keys`, `-keys ITEM`, `-keys markdown`: what a scene may say. */
static PetscErrorCode print_keys(const char *item, int *exit_code)
{
  PetscMPIInt rank;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (rank) PetscFunctionReturn(PETSC_SUCCESS);
  if (!strcmp(item, "markdown")) {
    keys_print_markdown();
  } else if (!keys_print(item)) {
    fprintf(stderr, "stickslip: no item of a scene is called '%s'; there are: ", item);
    keys_print_items();
    *exit_code = 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FILE_results in the current folder, for PATH/FILE.yaml */
static PetscErrorCode name_directory(const char *scene, char directory[], size_t length)
{
  const char *name = strrchr(scene, '/') ? strrchr(scene, '/') + 1 : scene, *dot = strrchr(name, '.');
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(directory, length, "%.*s_results", (int)(dot && dot > name ? dot - name : (ptrdiff_t)strlen(name)), name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  char      scene[PETSC_MAX_PATH_LEN] = "", directory[PETSC_MAX_PATH_LEN] = "", converted[PETSC_MAX_PATH_LEN] = "", item[NAME_LENGTH] = "";
  PetscBool have_scene, have_directory, convert, keys;
  PetscInt  status    = 0;
  int       exit_code = 0;
  Model     model     = {0};

  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCall(PetscTime(&model.output.started));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-keys", item, sizeof(item), &keys));
  if (keys) {
    PetscCall(print_keys(item, &exit_code));
    PetscCall(PetscFinalize());
    return exit_code;
  }
  PetscCall(find_scene(argc, argv, scene, sizeof(scene), &have_scene));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-output_dir", directory, sizeof(directory), &have_directory));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-convert", converted, sizeof(converted), &convert));
  if (!have_scene) {
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: the scene is missing: name its YAML file.\n"
                           "usage: %s FILE.yaml [-output_dir DIR] [any PETSc option]\n"
                           "       %s -keys [LIST]     what a scene may say\n", argv[0], argv[0]));
    PetscCall(PetscFinalize());
    return 1;
  }
  if (!have_directory) PetscCall(name_directory(scene, directory, sizeof(directory)));
  connect(&model);
  model.output.directory = directory;
  PetscCall(scene_open(scene, argc, argv, &model.scene));
  if (convert) {
    PetscCall(mesh_create(model.scene, &model.mesh));
    PetscCall(converted_write(model.scene, &model.mesh, converted));
    PetscCall(mesh_destroy(&model.mesh));
    PetscCall(scene_close(&model.scene));
    PetscCall(PetscFinalize());
    return 0;
  }
  PetscCall(read_scene(&model));
  PetscCall(build(&model, &status));
  if (status) {
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR, "stickslip: refused by the library: %s\n",
                           model.contact.refusal));
    exit_code = 3;
  } else {
    PetscCall(run(&model, &exit_code));
  }
  PetscCall(clean_up(&model));
  PetscCall(PetscFinalize());
  return exit_code;
}
