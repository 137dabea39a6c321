/* Potentials (potential.h), and their term: E = sum over nodes of a_k l u_k(x), l the length that is a node's, a_k the factors. */
#include "rod/potential.h"
#include "rod/term.h"
#include <assert.h>

struct RodPotential {
    FormulaOfPlace of; /* its formula is owned */
};

enum { NUMBERS = 3 }; /* t, s, L */

const char *const rod_place_variables[] = {"x", "y", "z", "r", "t", "s", "L", NULL};

RodPotential *rod_potential_create(Formula *formula, double length)
{
    RodPotential *potential = mem_alloc(1, sizeof *potential);
    potential->of = (FormulaOfPlace){formula, 1, NUMBERS, length / 64};
    return potential;
}

/* As rod_potential_known; NaN where u is not finite. */
static void eval_jet(const RodPotential *potential, RodPlace at, FormulaJet *jet)
{
    double numbers[NUMBERS] = {at.time, at.s, at.L};
    formula_jet(&potential->of, at.x, numbers, jet);
}

static bool find_value(const RodPotential *potential, RodPlace at, double *u, Error *err)
{
    double numbers[NUMBERS] = {at.time, at.s, at.L};
    return formula_jet_value(&potential->of, at.x, numbers, u, err);
}

bool rod_potential_known(const RodPotential *potential, RodPlace at, FormulaJet *jet, Error *err)
{
    eval_jet(potential, at, jet);
    if (isfinite(jet->value[0])) return true;
    double u;
    return find_value(potential, at, &u, err) &&
           error_set(err, "a potential is not finite everywhere within %g m of x = %g, y = %g, z = %g",
                     4 * potential->of.step, at.x.x, at.x.y, at.x.z);
}

void rod_potentials_add(RodPotentials *potentials, RodPotential *potential)
{
    size_t count = (size_t)potentials->count++;
    potentials->items = mem_resize(potentials->items, count, count + 1, sizeof(RodPotential *));
    potentials->items[count] = potential;
}

void rod_potentials_clear(RodPotentials *potentials)
{
    for (int k = 0; k < potentials->count; k++) {
        formula_destroy(potentials->items[k]->of.formula);
        mem_free(potentials->items[k]);
    }
    mem_free(potentials->items);
}

/* ---- The term ---- */

static void potential_dofs(const void *self, int node, int *dof)
{
    const RodLayout *layout = &((const RodTerm *)self)->layout;
    for (int i = 0; i < 3; i++) dof[i] = layout->position + 3 * node + i;
}

/* The length that is a node's. */
static double share(const Rod *rod, int node)
{
    int each = rod_each(rod), i = node % (each + 1);
    double h = rod_element_length(rod, node / (each + 1) * each);
    return i == 0 || i == each ? h / 2 : h;
}

static RodPlace place_of(const RodTerm *term, int node, const Point *at, const Pack *x, int lane)
{
    int each = term->layout.each, strand = node / (each + 1);
    double L = term->rod->strand[strand].length;
    return (RodPlace){vec3(x[0][lane], x[1][lane], x[2][lane]), at->time, L * (node % (each + 1)) / each, L};
}

/* The sum with these factors, times the node's length. */
static FormulaJet jet_at(const RodTerm *term, int node, RodPlace place, const double *factor)
{
    FormulaJet sum = {0}, own;
    for (int k = 0; k < term->rod->potentials.count; k++) {
        double a = factor[k] * share(term->rod, node);
        if (a == 0) continue;
        eval_jet(term->rod->potentials.items[k], place, &own);
        sum.value[0] += a * own.value[0];
        for (int i = 0; i < 3; i++) {
            sum.gradient[0][i] += a * own.gradient[0][i];
            for (int j = 0; j < 3; j++) sum.curvature[0][i][j] += a * own.curvature[0][i][j];
        }
    }
    return sum;
}

/* The value alone, which takes a fiftieth. */
static double value_at(const RodTerm *term, int node, RodPlace place, const double *factor)
{
    double sum = 0, u;
    for (int k = 0; k < term->rod->potentials.count; k++) {
        double a = factor[k] * share(term->rod, node);
        if (a != 0) sum += find_value(term->rod->potentials.items[k], place, &u, NULL) ? a * u : NAN;
    }
    return sum;
}

static Pack potential_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const RodTerm *term = self;
    const double *factor = at->p + term->rod->potential_scale;
    Pack energy;
    for (int l = 0; l < PACK_LANES; l++) {
        int node = rod_term_node(term, pack, l);
        RodPlace place = place_of(term, node, at, x, l);
        if (!g && !H) {
            energy[l] = value_at(term, node, place, factor);
            continue;
        }
        FormulaJet jet = jet_at(term, node, place, factor);
        energy[l] = jet.value[0];
        for (int i = 0; i < 3; i++) {
            if (g) g[i][l] = jet.gradient[0][i];
            for (int j = 0; H && j <= i; j++) H[TERM_LOWER(i, j)][l] = jet.curvature[0][i][j];
        }
    }
    return energy;
}

static void potential_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                            const Pack *w, double *dp)
{
    const RodTerm *term = self;
    const Rod *rod = term->rod;
    FormulaJet jet;
    for (int l = 0; l < lanes; l++) {
        int node = rod_term_node(term, pack, l);
        RodPlace place = place_of(term, node, at, x, l);
        for (int k = 0; k < rod->potentials.count; k++) {
            eval_jet(rod->potentials.items[k], place, &jet);
            double sum = 0;
            for (int i = 0; i < 3; i++) sum += w[i][l] * jet.gradient[0][i];
            dp[rod->potential_scale + k] += share(rod, node) * sum;
        }
    }
}

static void potential_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                    const double *dp, Pack *r)
{
    const RodTerm *term = self;
    for (int l = 0; l < PACK_LANES; l++) {
        int node = rod_term_node(term, pack, l);
        FormulaJet jet = jet_at(term, node, place_of(term, node, at, x, l), dp + term->rod->potential_scale);
        for (int i = 0; i < 3; i++) r[i][l] = jet.gradient[0][i];
    }
}

static const TermOps potential_ops = {
    .name = "potential",
    .count = rod_term_nodes,
    .size = rod_term_three,
    .dofs = potential_dofs,
    .eval = potential_eval,
    .param = potential_param,
    .param_forward = potential_param_forward,
    .destroy = mem_free,
};

Term rod_potential_term(const Rod *rod, RodLayout layout, double hold)
{
    assert(layout.position >= 0);
    return rod_term_make(&potential_ops, rod, layout, hold);
}
