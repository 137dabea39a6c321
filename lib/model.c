/* Models: their parts, parameters and systems. */
#include "base/memory.h"
#include "lib/objects.h"
#include "solve/kernels.h"
#include <stdatomic.h>
#include <string.h>

static atomic_ulong last_id;

typedef struct Making {
    SlenderScene *scene;
    int threads;
    SlenderModel *model; /* made */
} Making;

/* A line each. */
static char *warnings_of(const Model *model)
{
    char *text = mem_text("");
    for (int k = 0; k < model->report.warning_count; k++)
        text = mem_join(text, model->report.warnings[k], "\n");
    return text;
}

static SlenderStatus make(void *self, Error *err)
{
    Making *making = self;
    Model *model = NULL;
    SlenderStatus status = lib_build(making->scene, making->threads, true, &model, err);
    if (status != SLENDER_DONE) return status;
    if (!model->case_count) {
        lib_refuse(err, "a scene with %s and `job: %s` has no load cases; it can be run", model->body->noun,
                   model->job->name);
        model_destroy(model);
        return SLENDER_REFUSED;
    }
    SlenderModel *made = making->model = mem_alloc(1, sizeof *made);
    *made = (SlenderModel){.scene = making->scene,
                           .model = model,
                           .warnings = warnings_of(model),
                           .id = atomic_fetch_add(&last_id, 1) + 1};
    made->cases = mem_alloc((size_t)model->case_count, sizeof *made->cases);
    int threads = kernels_reserve(making->threads);
    if (threads > 1) made->workers = workers_create(threads);
    for (int c = 0; c < model->case_count; c++) {
        if (model->job->motion)
            made->cases[c].motion = model->cases[c].sys;
        else
            made->cases[c].statics = model->cases[c].sys;
        system_set_workers(model->cases[c].sys, made->workers);
    }
    lib_system(made, 0, false); /* whose terms slender_model_info counts */
    return SLENDER_DONE;
}

SlenderModel *slender_model_create(const SlenderScene *scene, int threads, SlenderError *err)
{
    Making making = {.scene = (SlenderScene *)scene, .threads = threads};
    return lib_call(make, &making, err) == SLENDER_DONE ? making.model : NULL;
}

void slender_model_destroy(SlenderModel *model)
{
    if (!model) return;
    for (int c = 0; c < model->model->case_count; c++)
        system_destroy(model->model->job->motion ? model->cases[c].statics : model->cases[c].motion);
    model_destroy(model->model);
    workers_destroy(model->workers);
    mem_free(model->cases);
    mem_free(model->warnings);
    mem_free(model);
}

/* ---- What it is ---- */

SlenderModelInfo slender_model_info(const SlenderModel *model)
{
    const Model *m = model->model;
    const System *sys = model->cases[0].statics;
    const State *start = &m->cases[0].state;
    return (SlenderModelInfo){
        .cases = m->case_count,
        .terms = system_term_count(sys),
        .blocks = m->params->block_count,
        .points = m->point_count,
        .dofs = start->dofs,
        .params = m->params->size,
        .faces = m->mesh ? m->mesh->face_count : 0,
        .memory = start->memory_count,
        .rest = m->x,
        .face = m->mesh ? m->mesh->faces[0] : NULL,
        .warnings = model->warnings,
    };
}

const char *slender_model_case(const SlenderModel *model, int load_case)
{
    bool is = load_case >= 0 && load_case < model->model->case_count;
    return is ? model->model->cases[load_case].name : NULL;
}

const char *slender_model_term(const SlenderModel *model, int term)
{
    const System *sys = model->cases[0].statics;
    return term >= 0 && term < system_term_count(sys) ? system_term(sys, term)->ops->name : NULL;
}

/* ---- Parameters ---- */

/* Does each load case have its own? What a case of a scene can say. */
static bool is_per_case(const Model *model, const ParamBlock *block)
{
    int at = block->offset;
    return block->load || at == model->gravity || at == model->flux_blocks.uniform ||
           at == model->flux_blocks.scale;
}

SlenderBlock slender_model_block(const SlenderModel *model, int block)
{
    const Model *m = model->model;
    if (block < 0 || block >= m->params->block_count) return (SlenderBlock){0};
    const ParamBlock *from = &m->params->blocks[block];
    return (SlenderBlock){from->name,  from->unit,  from->offset,
                          from->count, from->width, is_per_case(m, from)};
}

double *slender_model_params(SlenderModel *model, int load_case)
{
    bool is = load_case >= 0 && load_case < model->model->case_count;
    return is ? model->model->cases[load_case].stages[0].p : NULL;
}

double *lib_params(SlenderModel *model, int load_case)
{
    const Model *m = model->model;
    double *p = m->cases[load_case].stages[0].p;
    const double *shared = m->cases[0].stages[0].p;
    for (int k = 0; load_case > 0 && k < m->params->block_count; k++) {
        const ParamBlock *block = &m->params->blocks[k];
        size_t count = (size_t)block->count * (size_t)block->width;
        if (!is_per_case(m, block)) memcpy(p + block->offset, shared + block->offset, count * sizeof *p);
    }
    return p;
}

/* ---- Systems ---- */

bool lib_has_case(const SlenderModel *model, int load_case, Error *err)
{
    int count = model->model->case_count;
    return (load_case >= 0 && load_case < count) ||
           error_set(err, "there is no load case %d: there are %d, from 0 on", load_case, count);
}

System *lib_system(SlenderModel *model, int load_case, bool motion)
{
    LibCase *c = &model->cases[load_case];
    System **sys = motion ? &c->motion : &c->statics;
    if (!*sys) {
        *sys = model_take_system(model->model, model->model->body->ops->system(model->model, motion));
        system_set_workers(*sys, model->workers);
    }
    return *sys;
}
