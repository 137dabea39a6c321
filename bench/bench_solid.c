/* A cube of 4374 tetrahedra, sheared, one thread: the elastic kernel alone, and the assembly of all terms. */
#include "base/clock.h"
#include "base/memory.h"
#include "bench/bench.h"
#include "solid/shapes.h"
#include "solid/terms.h"
#include "surface/face.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CELLS = 9, REPEATS = 30 };

static Solid *cube_of(int order, double averaging)
{
    MeshFile file;
    Error err;
    if (!solid_shape_box((double[]){0.02, 0.02, 0.02}, (int[]){CELLS, CELLS, CELLS}, &file, &err))
        bench_fail("%s", err.text);
    Tets *tets = tets_create(&file, order, NULL, &err);
    mesh_file_clear(&file);
    if (!tets) bench_fail("%s", err.text);
    const SolidDef def = {.poisson = 0.45, .density = 1000, .averaging = averaging, .skin = 1e-3};
    return solid_create(tets, &def, NULL);
}

/* Its packs one after the other: E, with g, with H. */
static double kernel_seconds(const Solid *solid, const State *state, const double *p, int derivatives)
{
    Term term = solid_elastic_term(solid);
    Point at = state_point(state, p);
    int size = term.ops->size(term.self), count = term.ops->count(term.self);
    Pack *x = mem_alloc((size_t)size, sizeof *x), *g = mem_alloc((size_t)size, sizeof *g),
         *H = mem_alloc((size_t)TERM_LOWER(size, 0), sizeof *H);
    double best = INFINITY, sum = 0;
    for (int r = 0; r < REPEATS; r++) {
        double seconds = 0;
        for (int k = 0; k < pack_count(count); k++) {
            for (int l = 0; l < PACK_LANES; l++) {
                int dof[TERM_MAX_DOF];
                term.ops->dofs(term.self, pack_element(count, k, l), dof);
                for (int i = 0; i < size; i++) x[i][l] = state->x[dof[i]];
            }
            double start = clock_seconds();
            Pack E =
                term.ops->eval(term.self, k, &at, x, derivatives > 0 ? g : NULL, derivatives > 1 ? H : NULL);
            seconds += clock_seconds() - start;
            sum += E[0];
        }
        best = fmin(best, seconds);
    }
    if (!(sum > 0)) bench_fail("a sheared cube has no energy");
    term.ops->destroy(term.self);
    mem_free(x), mem_free(g), mem_free(H);
    return best;
}

static double assembly_seconds(System *sys, const State *state, const double *p)
{
    Point at = state_point(state, p);
    double *gradient = mem_alloc((size_t)system_dof_count(sys), sizeof *gradient), best = INFINITY;
    for (int r = 0; r < REPEATS; r++) {
        double start = clock_seconds();
        system_hessian(sys, &at, gradient);
        best = fmin(best, clock_seconds() - start);
    }
    mem_free(gradient);
    return best;
}

static void time_elements(const char *name, int order, double averaging)
{
    static const char *const parts[] = {"energy", "gradient", "hessian"};
    Solid *solid = cube_of(order, averaging);
    System *sys = solid_system(solid, false);
    State state = system_state(sys);
    double *p = mem_alloc((size_t)solid->params.size, sizeof *p), tets = solid->tets->count;
    char text[80];
    solid_default_params(solid, p);
    for (int i = 0; i < solid_dof_count(solid); i++) {
        const double *X = solid->tets->surface->rest[i / 3];
        state.x[i] = X[i % 3] + 0.2 * X[(i + 1) % 3] + 4 * X[0] * X[1];
    }
    for (int d = 0; d < 3 && averaging == 0; d++) {
        snprintf(text, sizeof text, "solid_kernel_%s_%s_us_per_tet", name, parts[d]);
        bench_print(text, 1e6 * kernel_seconds(solid, &state, p, d) / tets, "us");
    }
    snprintf(text, sizeof text, "solid_assembly_%s_us_per_tet", name);
    bench_print(text, 1e6 * assembly_seconds(sys, &state, p) / tets, "us");
    state_destroy(&state);
    system_destroy(sys);
    solid_destroy(solid);
    mem_free(p);
}

void bench_solid(void)
{
    time_elements("linear", TET_LINEAR, 0);
    time_elements("linear_patches", TET_LINEAR, 1);
    time_elements("quadratic", TET_QUADRATIC, 0);
    time_elements("quadratic_mean", TET_QUADRATIC, 0.6);
}
