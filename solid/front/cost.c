/* What a solid's evaluation and factor take, from those of a small block. */
#include "base/memory.h"
#include "job/predict.h"
#include "solid/front/front.h"
#include "solid/shapes.h"
#include "solve/kernels.h"
#include <math.h>

enum { BLOCK = 6, REPEATS = 4, EXACT = 400000 };

/* Numbers of L and flops of a cube with so many unknowns: nested dissection in space, n^4/3 and n^2 [George 1973], as
 * measured on cubes of 150 000 and 350 000 (docs/scale.md). Flat and long ones take less. */
static const double NUMBERS = 22, FLOPS = 23, BYTES = 9.7, SYSTEM_BYTES[] = {1500, 20000},
                    PICTURE_SECONDS = 0.4;

/* A cube of the solid's order and material, at rest, held on one side. */
static Solid *block_of(const Solid *like)
{
    MeshFile file;
    Error err;
    solid_shape_box((double[]){1, 1, 1}, (int[]){BLOCK, BLOCK, BLOCK}, &file, &err);
    SolidDef def = {like->material, like->poisson, like->density,      like->averaging,
                    like->skin,     like->film,    like->film_poisson, like->film_material};
    Solid *solid = solid_create(tets_create(&file, like->tets->order, NULL, &err), &def, NULL);
    mesh_file_clear(&file);
    for (int i = 0; i < solid_dof_count(solid); i++)
        solid->fixed[i] = solid->tets->surface->rest[i / 3][0] == 0;
    return solid;
}

void solid_cost(const Model *model, Cost *cost)
{
    const Solid *solid = model->self;
    Solid *block = block_of(solid);
    System *sys = solid_system(block, false);
    double *p = mem_alloc((size_t)block->params.size, sizeof *p),
           unknowns = system_free_count(model->cases[0].sys);
    State state = system_state(sys);
    solid_default_params(block, p);
    for (int i = 0; i < solid_dof_count(block); i++) state.x[i] = block->tets->surface->rest[i / 3][i % 3];
    Point at = state_point(&state, p);
    predict_measure(sys, &at, REPEATS, cost);
    SparseInfo info = system_info(sys);
    double parts = (double)solid->tets->count / block->tets->count, rate = kernels_flops(),
           numbers = (double)info.factor_nonzeros,
           each = fmax(0, (cost->factor - info.factor_flops / rate) / numbers);
    cost->exact = unknowns <= EXACT;
    if (cost->exact) {
        predict_take_factor(system_cost(model->cases[0].sys), cost);
    } else {
        cost->numbers = NUMBERS * pow(unknowns, 4.0 / 3), cost->flops = FLOPS * unknowns * unknowns;
        cost->factor_bytes = BYTES * cost->numbers;
    }
    cost->hessian *= parts, cost->build *= parts;
    cost->factor = each * cost->numbers + cost->flops / rate;
    cost->solve *= cost->numbers / numbers;
    cost->elements = solid->tets->count;
    cost->system_bytes = SYSTEM_BYTES[solid->tets->order - 1];
    cost->picture = PICTURE_SECONDS;
    cost->stability = true;
    state_destroy(&state);
    mem_free(p);
    system_destroy(sys);
    solid_destroy(block);
}
