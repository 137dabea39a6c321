/* Positions of a rod where rotations (and the strains of a Cosserat rod) have them: c = x_b - x_a - chord = 0 for each
 * element, by its multiplier lambda, the force of the element on its first node:
 *
 *     E = lambda.c + hold/2 |c|^2
 *
 * The second part (an augmented Lagrangian) is 0 wherever a rod may be and changes no solution, but makes the
 * matrix definite in the positions, so that its LDL^T needs no pivoting. Trials are made admissible by
 * putting the positions where the rest has them; only a held end is reached by Newton's steps. */
#include "rod/chord.h"

enum { XA, XB, LAMBDA, TURN_A, TURN_B, STRAIN, BLOCKS }; /* an element's dofs, three each */

/* Only Cosserat rods have the last ones. */
static int blocks_of(bool stretches)
{
    return stretches ? BLOCKS : STRAIN;
}

static int link_size(const void *self)
{
    return 3 * blocks_of(((const RodTerm *)self)->layout.strain >= 0);
}

static void link_dofs(const void *self, int e, int *dof)
{
    const RodLayout *layout = &((const RodTerm *)self)->layout;
    for (int i = 0; i < 6; i++) {
        int node = rod_element_node(layout, e);
        dof[i] = layout->position + 3 * node + i;
        dof[3 * TURN_A + i] = layout->turn + 3 * node + i;
        if (i < 3) dof[3 * LAMBDA + i] = layout->multiplier + 3 * e + i;
    }
    rod_term_strain_dofs(self, e, dof + 3 * STRAIN);
}

/* dc of the turns of a or of b, or of the strain: the rows are its three numbers. */
static PackMat rates(const Chord *chord, int block)
{
    Pack3 zero = {{0}, {0}, {0}}, row[3];
    for (int i = 0; i < 3; i++) {
        Pack3 unit = pack3(pack_set(i == 0), pack_set(i == 1), pack_set(i == 2));
        row[i] = pack3_neg(block == TURN_A   ? chord_rate(chord, unit, zero)
                           : block == TURN_B ? chord_rate(chord, zero, unit)
                                             : chord_strain_rate(chord, unit));
    }
    return (PackMat){row[0], row[1], row[2]};
}

/* What a force does as chords bend. */
static void add_bent(const Chord *chord, Pack3 force, Pack *H)
{
    PackMat block[3];
    chord_hessian(chord, force, block);
    rod_term_add_blocks(H, TURN_A, block);
    if (!chord->stretches) return;
    chord_mixed_hessian(chord, force, block);
    for (int k = 0; k < 2; k++) element_add_block(H, STRAIN, TURN_A + k, block[k]);
}

static void hessian(const Chord *chord, Pack hold, Pack3 force, Pack *H)
{
    int blocks = blocks_of(chord->stretches);
    element_clear(H, 3 * blocks);
    add_bent(chord, force, H);
    PackMat rows[BLOCKS];
    for (int i = TURN_A; i < blocks; i++) rows[i] = rates(chord, i);
    for (int i = TURN_A; i < blocks; i++) {
        PackMat held = pack_mat_scale(hold, rows[i]);
        element_add_diagonal(H, i, pack_mat_product(held, pack_mat_transpose(rows[i])));
        for (int j = i + 1; j < blocks; j++)
            element_add_block(H, i, j, pack_mat_product(held, pack_mat_transpose(rows[j])));
        element_add_block(H, i, LAMBDA, rows[i]);
        element_add_block(H, i, XA, pack_mat_neg(held));
        element_add_block(H, i, XB, held);
    }
    for (int k = 0; k < 2; k++) {
        element_add_diagonal(H, XA + k, pack_mat_diagonal(hold));
        element_add_block(H, LAMBDA, XA + k, pack_mat_diagonal(pack_set(k == 0 ? -1 : 1)));
    }
    element_add_block(H, XA, XB, pack_mat_diagonal(-hold));
}

static Pack link_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const RodTerm *term = self;
    Chord chord = chord_at(term, pack, at->x, x + 3 * TURN_A);
    Pack hold = pack_set(term->hold);
    Pack3 lambda = pack3_load(x + 3 * LAMBDA),
          c = pack3_sub(pack3_sub(pack3_load(x + 3 * XB), pack3_load(x)), chord_world(&chord));
    Pack3 force = pack3_axpy(hold, c, lambda);
    if (g) {
        rod_term_clear(g, 3 * blocks_of(chord.stretches));
        pack3_store(g + 3 * XA, pack3_neg(force));
        pack3_store(g + 3 * XB, force);
        chord_gradient(&chord, force, g + 3 * TURN_A);
        rod_term_turn_gradient(&chord.s, g + 3 * TURN_A);
        pack3_store(g + 3 * LAMBDA, c);
    }
    if (H) hessian(&chord, hold, force, H);
    return pack3_dot(lambda, c) + hold / 2 * pack3_dot(c, c);
}

/* Positions where rotations and strains have them; a held end stays. */
static void link_project(const void *self, const double *from, double *x)
{
    (void)from;
    const RodTerm *term = self;
    int nodes = term->layout.nodes;
    rod_places(term->rod, &term->layout, x, term->rod->end == ROD_FREE ? nodes : nodes - 1,
               x + term->layout.position);
}

static const TermOps link_ops = {
    .name = "link",
    .count = rod_term_count,
    .size = link_size,
    .dofs = link_dofs,
    .eval = link_eval,
    .project = link_project,
    .destroy = mem_free,
};

Term rod_link_term(const Rod *rod, RodLayout layout, double hold)
{
    return rod_term_make(&link_ops, rod, layout, hold);
}
