/* Systems with three rows for every node (node_blocks.c). */
#ifndef STICKSLIP_PROGRAM_NODE_BLOCKS_H
#define STICKSLIP_PROGRAM_NODE_BLOCKS_H
#include "physics/physics.h"

typedef struct {
  Mat place;       /* equations in terms of nodes' components: one 1 a row, none of rigid bodies */
  Vec prescribed;  /* 1 in components that have no equation, or a rigid body's, else 0 */
  Vec coordinates; /* at rest */
} NodeBlocks;

PetscErrorCode node_blocks_create(const Physics *physics, Mat like, NodeBlocks *blocks);
PetscErrorCode node_blocks_destroy(NodeBlocks *blocks);
/* A copy of a matrix of components in whole blocks, without what is below `least` times the largest entry of a node's own rows, with a
 * typical entry on the diagonal of what is prescribed. */
PetscErrorCode node_blocks_matrix(const NodeBlocks *blocks, Mat from, PetscReal least, Mat *to);
#endif
