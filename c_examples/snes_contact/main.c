/* snes_contact: frictional contact of elastic bodies, solved by PETSc's SNES with the stickslip contact element.
 *
 *   snes_contact -scene FILE.yaml -output_dir DIR [any PETSc option]
 *
 * The scene's format is documented in scenes/README.md. Exit codes: 0 every step converged, 1 bad scene, 2 not converged,
 * 3 refused by the contact library. */
#include "model.h"

static const char help[] = "Frictional contact of elastic bodies.\n"
                           "  -scene FILE.yaml   what to solve (format: c_examples/scenes/README.md)\n"
                           "  -output_dir DIR    where summary.json, interface_*.csv and step_*.vtu go\n"
                           "  -test_jacobian_blocks  compare the tangent with differences of the residual\n"
                           "Every value of the scene can be overridden: `block: {young: 1}` by -block_young 1.\n\n";

static PetscErrorCode read_scene(Model *model)
{
  static const char *const maps[] = {"frame", "steps", "output"};
  PetscReal                schema = 0;
  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    if (scene_has(model->scene, NULL, maps[k]))
      scene_fail(model->scene, NULL, maps[k], "a map is expected here, not a single value or a list.");
  }
  if (!scene_has(model->scene, NULL, "schema"))
    scene_fail(model->scene, NULL, "schema", "this key is missing: begin the file with `schema: 1`.");
  scene_real_required(model->scene, NULL, "schema", &schema);
  if (schema != 1) scene_fail(model->scene, NULL, "schema", "this program reads schema 1, not %g.", (double)schema);
  PetscCall(mesh_create(model->scene, &model->mesh));
  PetscCall(steps_read(model));
  PetscCall(supports_read(model));
  PetscCall(loads_read(model));
  PetscCall(contact_read(model));
  PetscCall(output_read(model));
  scene_root_begin(model->scene); /* rank 0 has read every key */
  if (model->rank == 0) scene_check_unread(model->scene, PETSC_FALSE);
  PetscCall(scene_root_end(model->scene));
  PetscCall(mesh_rotate(&model->mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode build(Model *model, PetscInt *status)
{
  PetscFunctionBegin;
  PetscCall(plex_create(model));
  PetscCall(supports_label(model));
  PetscCall(loads_label(model));
  PetscCall(contact_label(model));
  PetscCall(parts_label(model));
  PetscCall(plex_distribute(model));
  PetscCall(unknowns_create(model));
  PetscCall(parts_create(model));
  PetscCall(held_create(model));
  PetscCall(bulk_create(model));
  PetscCall(loads_assemble(model));
  PetscCall(contact_create(model, status));
  if (*status) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(supports_values(model, 0));
  PetscCall(VecCopy(model->prescribed_local, model->u_local)); /* the configuration of the first sparsity pattern */
  PetscCall(solver_create(model));
  PetscCall(newton_create(model));
  PetscCall(jacobian_test_create(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode clean_up(Model *model)
{
  PetscFunctionBegin;
  PetscCall(contact_destroy(model));
  PetscCall(parts_destroy(model));
  PetscCall(held_destroy(model));
  PetscCall(PetscFree(model->ranges));
  for (PetscInt s = 0; s < model->n_supports; s++) {
    PetscCall(PetscFree(model->supports[s].curve.points));
    PetscCall(PetscFree(model->supports[s].rotate_curve.points));
  }
  for (PetscInt l = 0; l < model->n_loads; l++) {
    PetscCall(PetscFree(model->loads[l].curve.points));
    PetscCall(PetscFree(model->loads[l].surfaces));
    PetscCall(VecDestroy(&model->loads[l].forces));
  }
  PetscCall(PetscFree(model->supports));
  PetscCall(PetscFree(model->loads));
  PetscCall(PetscFree(model->probes));
  PetscCall(PetscFree(model->prescribed));
  PetscCall(newton_destroy(model));
  PetscCall(PetscFree(model->steps.targets));
  PetscCall(PetscFree(model->steps.asked));
  PetscCall(PetscFree(model->original));
  PetscCall(PetscFree(model->owner));
  PetscCall(PetscFree(model->ghost));
  PetscCall(PetscFree6(model->cell_offsets, model->cell_dofs, model->cell_body, model->cell_part, model->cell_X,
                       model->cell_stiffness));
  PetscCall(VecDestroy(&model->u_local));
  PetscCall(VecDestroy(&model->f_local));
  PetscCall(VecDestroy(&model->f_external));
  PetscCall(VecDestroy(&model->prescribed_local));
  PetscCall(VecDestroy(&model->f_sum));
  PetscCall(PetscSFDestroy(&model->ghosts));
  PetscCall(PetscSFDestroy(&model->all_displacements));
  PetscCall(MatDestroy(&model->jacobian));
  PetscCall(MatDestroy(&model->pattern));
  PetscCall(SNESDestroy(&model->snes));
  PetscCall(PetscSectionDestroy(&model->section));
  PetscCall(DMDestroy(&model->dm));
  PetscCall(mesh_destroy(&model->mesh));
  PetscCall(scene_close(&model->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  char      scene[PETSC_MAX_PATH_LEN] = "", directory[PETSC_MAX_PATH_LEN] = "";
  PetscBool have_scene, have_directory;
  PetscInt  status    = 0;
  int       exit_code = 0;
  Model     model     = {0};

  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCall(PetscTime(&model.timers.total));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &model.rank));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-scene", scene, sizeof(scene), &have_scene));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-output_dir", directory, sizeof(directory), &have_directory));
  if (!have_scene || !have_directory) {
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "snes_contact: %s is missing: %s.\n"
                           "usage: snes_contact -scene FILE.yaml -output_dir DIR [any PETSc option]\n",
                           have_scene ? "-output_dir" : "-scene",
                           have_scene ? "name a folder for the results, which is made if it is not there" :
                                        "name the YAML file of the scene"));
    PetscCall(PetscFinalize());
    return 1;
  }
  model.output_dir = directory;
  PetscCall(scene_open(scene, argc, argv, &model.scene));
  PetscCall(read_scene(&model));
  PetscCall(build(&model, &status));
  if (status) {
    PetscCall(
        PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR, "snes_contact: refused by the library: %s\n", model.refusal));
    exit_code = 3;
  } else {
    PetscCall(steps_run(&model, &exit_code));
  }
  PetscCall(clean_up(&model));
  PetscCall(PetscFinalize());
  return exit_code;
}
