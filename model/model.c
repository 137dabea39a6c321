#include "model/model.h"
#include "base/memory.h"
#include "io/table.h"
#include "model/advise.h"
#include "model/probe.h"
#include "model/scene_tables.h"
#include "model/sequence.h"
#include "model/start.h"
#include "model/world_report.h"
#include <math.h>
#include <string.h>

/* ---- Formulas that are not finite in a run ---- */

/* how: what sentences about it begin with. */
static void keep_written(Model *model, const YamlFile *file, Key key, char *how)
{
    size_t count = (size_t)model->written_count;
    if (!yaml_says(file, key.text)) {
        mem_free(how);
        return;
    }
    model->written = mem_resize(model->written, count, count + 1, sizeof *model->written);
    model->written[model->written_count++] = (Written){how, yaml_where(file, key.text)};
}

static void keep_all_written(Model *model, const Scene *scene, const YamlFile *file)
{
    static const char *const keys[] = {"flux_density", "water.velocity", "rod.loads"};
    for (int k = 0; k < 3; k++) keep_written(model, file, key("%s", keys[k]), mem_text(keys[k]));
    for (int k = 0; k < scene->fix_count; k++) {
        Key at = key("fix[%d].move", k);
        keep_written(model, file, at, mem_text(at.text));
    }
    for (int k = 0; model->world && k < model->world->obstacle_count; k++)
        keep_written(model, file, key("obstacles[%d]", k),
                     mem_format("obstacle '%s'", model->world->obstacles[k].name));
}

/* Adds where that is written of which the sentence begins to speak; false. */
static bool add_where(const Model *model, Error *err)
{
    for (int k = 0; k < model->written_count; k++) {
        size_t length = strlen(model->written[k].how);
        if (strncmp(err->text, model->written[k].how, length) != 0 || err->text[length] != ':') continue;
        Error said = *err;
        return error_set(err, "%s (%s)", said.text, model->written[k].where);
    }
    return false;
}

bool model_unknown(const Model *model, const char *key, Error *err)
{
    error_prefix(err, "%s", key);
    return add_where(model, err);
}

bool model_move(const Model *model, HeldWay way, double *x, Error *err)
{
    return !model->moves || model->body->ops->move(model, way, x, err);
}

bool model_load(const Model *model, double time, bool flux_given, double *p, Error *err)
{
    const Timed *timed = &model->flux_of_time;
    const BodyOps *ops = model->body->ops;
    if (ops->load && !ops->load(model, time, p, err)) return false;
    if (!flux_given && timed_is_given(timed) && !timed_eval(timed, time, p + model->flux_blocks.uniform, err))
        return model_unknown(model, "flux_density", err);
    return !model->world || world_stands(model->world, time, err) || add_where(model, err);
}

/* ---- Loads of a case ---- */

/* What a case or a stage says, NULL or NAN where it does not, and where. */
typedef struct Said {
    Key loads_at, gravity_at, flux_at;
    const LoadScene *loads;
    int count;
    const double *gravity;
    const FluxScene *flux;
} Said;

static bool feels_none(const Model *model, const Build *b, Key at)
{
    return yaml_refuse(b->file, at.text, "%s feels none", model->body->noun);
}

/* Loads and gravity; and is its field felt? */
static bool put_loads(Model *model, const Build *b, const Said *said, double *p)
{
    bool pulls = !isnan(said->gravity[0]);
    if (pulls && model->gravity < 0) return feels_none(model, b, said->gravity_at);
    if (said->flux && model->flux_blocks.uniform < 0) return feels_none(model, b, said->flux_at);
    if (pulls) memcpy(p + model->gravity, said->gravity, 3 * sizeof *p);
    return !said->loads ||
           model->body->ops->put_loads(model, b, said->loads_at.text, said->loads, said->count, p);
}

static Case *add_case(Model *model, const char *name, const double *p, double time)
{
    size_t count = (size_t)model->case_count++;
    model->cases = mem_resize(model->cases, count, count + 1, sizeof *model->cases);
    Case *c = &model->cases[count];
    char *number = name ? NULL : mem_format("case%zu", count + 1);
    *c = case_create(name ? name : number, p, (size_t)model->params->size, time);
    mem_free(number);
    return c;
}

/* Each from the one before. */
static bool add_stage(Model *model, const Build *b, const Scene *scene, int k, Case *c)
{
    StageScene stage = sequence_stage(scene, k);
    Stage *now = &c->stages[k];
    Build then = *b;
    if (k > 0) *now = (Stage){mem_copy(now[-1].p, (size_t)model->params->size, sizeof *now->p), now[-1].time};
    if (!isnan(stage.time)) now->time = stage.time;
    then.time = now->time;
    Said said = {.loads_at = sequence_key(scene, k, "loads"),
                 .gravity_at = sequence_key(scene, k, "gravity"),
                 .flux_at = sequence_key(scene, k, "flux_density"),
                 .loads = stage.loads,
                 .count = stage.loads_count,
                 .gravity = stage.gravity,
                 .flux = stage.flux_density};
    bool ok = put_loads(model, &then, &said, now->p);
    model_put_flux(model, 1 + k, now->p);
    return ok;
}

static bool add_stages(Model *model, const Build *b, const Scene *scene, const double *p)
{
    Case *c = add_case(model, "sequence", p, model->time);
    int said = sequence_said(scene), count;
    bool ok = true;
    if (!sequence_check(scene, b->file, &count)) return false;
    c->stages = mem_resize(c->stages, 1, (size_t)said, sizeof *c->stages);
    c->stage_count = said;
    for (int k = 0; k < said; k++) ok = add_stage(model, b, scene, k, c) && ok;
    if (ok && count > said) sequence_fill(c, count, model->params->size);
    return ok;
}

bool model_cases(Model *model, const Build *b, const Scene *scene, const double *p)
{
    if (scene->sequence && scene->cases_count)
        return yaml_refuse(b->file, "sequence", "a scene has either cases or a sequence");
    if (scene->sequence) return add_stages(model, b, scene, p);
    bool ok = true;
    for (int k = 0; k < scene->cases_count; k++) {
        const CaseScene *from = &scene->cases[k];
        Case *c = add_case(model, from->name, p, model->time);
        c->weight = from->weight;
        Key at = key("cases[%d]", k);
        for (int i = 0; i < k; i++)
            if (!strcmp(model->cases[i].name, c->name))
                ok = yaml_refuse(b->file, at.text, "there are two cases named '%s'", c->name);
        ok = build_check_name(b, at, "a case", c->name) && ok;
        Said said = {.loads_at = key("%s.loads", at.text),
                     .gravity_at = key("%s.gravity", at.text),
                     .flux_at = key("%s.flux_density", at.text),
                     .loads = from->loads,
                     .count = from->loads_count,
                     .gravity = from->gravity,
                     .flux = from->flux_density};
        ok = put_loads(model, b, &said, c->stages[0].p) && ok;
        model_put_flux(model, 1 + k, c->stages[0].p);
        ok = (from->target_count
                  ? model_targets(model, b, key("%s.target", at.text), from->target, from->target_count, c)
                  : model_targets(model, b, key("target"), scene->target, scene->target_count, c)) &&
             ok;
    }
    if (!scene->cases_count)
        ok = model_targets(model, b, key("target"), scene->target, scene->target_count,
                           add_case(model, NULL, p, model->time));
    return ok;
}

/* ---- The whole ---- */

/* A row for each point; of a mesh, in the order of its file or of its own. */
static bool velocities_from_file(const Model *model, Key at, const char *path, YamlFile *file, double *speed)
{
    const Mesh *mesh = model->mesh;
    Table table;
    Error err;
    at = key("%s.file", at.text);
    if (!table_read(path, "vx [m/s], vy [m/s], vz [m/s]", &table, &err))
        return yaml_refuse(file, at.text, "%s", err.text);
    bool ok = mesh ? mesh_fits(mesh, table.rows) : table.rows == model->point_count;
    if (!ok)
        yaml_refuse(file, at.text, "%s has %d rows, and there are %d %s: one row for each is needed", path,
                    table.rows, model->point_count, mesh ? "vertices" : "nodes");
    for (int k = 0; ok && k < model->point_count; k++)
        memcpy(speed + 3 * k, table.values + 3 * (mesh ? mesh_row(mesh, table.rows, k) : k),
               3 * sizeof *speed);
    table_clear(&table);
    return ok;
}

bool model_velocity(Model *model, const Build *b, const char *at, const VelocityScene *scene,
                    const double *place)
{
    const System *sys = model->cases[0].sys;
    double *v = model->cases[0].state.v;
    int count = 3 * model->point_count;
    if (!scene) return true;
    bool ok = true;
    if (scene->formula)
        ok = build_vectors_at(b, key("%s", at), scene->formula, scene->where, scene->where_count, place,
                              model->point_count, v);
    else if (scene->file)
        ok = velocities_from_file(model, key("%s", at), scene->file, b->file, v);
    else
        for (int i = 0; i < count; i++) v[i] = scene->value[i % 3];
    for (int i = 0; i < count; i++)
        if (system_is_fixed(sys, i)) v[i] = 0;
    return ok;
}

static bool check_motion(const Scene *scene, const JobRow *job, YamlFile *file)
{
    bool known = !isnan(scene->time.step) && scene->time.steps != YAML_ABSENT;
    return !job->motion || known ||
           yaml_refuse(file, "time", "%s needs `time`, e.g. time: {step: 1 ms, steps: 100}", job->noun);
}

/* "shells, rods and cables": those that have the job. */
static char *bodies_of(const char *job)
{
    char *list = mem_text("");
    const BodyRow *last = NULL;
    for (int k = 0; bodies[k]; k++)
        if (body_job(bodies[k], job)) last = bodies[k];
    for (int k = 0; bodies[k]; k++)
        if (body_job(bodies[k], job))
            list = mem_join(list, !*list ? "" : bodies[k] == last ? " and " : ", ", bodies[k]->nouns);
    return list;
}

static bool check_job(const Scene *scene, YamlFile *file)
{
    if (scene_job(scene)) return true;
    const char *name = scene_job_names[scene->job];
    char *list = bodies_of(name);
    yaml_refuse(file, "job", "%s is a job for %s, and the scene has %s", name, list, scene_body(scene)->noun);
    mem_free(list);
    return false;
}

static bool check_solver(const Scene *scene, YamlFile *file)
{
    Error err;
    return direct_is_ready(scene->solver.direct, &err) || yaml_refuse(file, "solver.direct", "%s", err.text);
}

static Model *create(const Scene *scene, YamlFile *file, bool general)
{
    Model *model = mem_alloc(1, sizeof *model);
    model->general = general;
    model->gravity = model->flux_blocks.uniform = -1;
    model->time = scene->time.at;
    model->direct = scene->solver.direct;
    const JobRow *job = scene_job(scene);
    model->body = scene_body(scene);
    model->job = job;
    bool ok = check_job(scene, file) && yaml_check_use(file, scene_table()) &&
              check_motion(scene, job, file) && check_solver(scene, file) && start_open(model, scene, file) &&
              model->body->ops->create(model, scene, file) && start_take(model, scene, file) &&
              (!job->design || model_design(model, scene, file)) && model_probes(model, scene, file);
    start_close(model->start);
    model->start = NULL;
    if (ok) keep_all_written(model, scene, file);
    if (ok) model_put_world(model, scene);
    ok = ok && model_check_world(model, file);
    if (ok) model_advise(model, scene);
    if (ok && model->body->ops->advise) model->body->ops->advise(model, scene);
    if (ok) world_advise(model);
    if (ok) return model;
    model_destroy(model);
    return NULL;
}

Model *model_create(const Scene *scene, YamlFile *file)
{
    return create(scene, file, false);
}

Model *model_create_general(const Scene *scene, YamlFile *file)
{
    return create(scene, file, true);
}

System *model_take_system(const Model *model, System *sys)
{
    system_set_direct(sys, model->direct);
    return sys;
}

void model_destroy(Model *model)
{
    if (!model) return;
    for (int k = 0; k < model->case_count; k++) case_clear(&model->cases[k]);
    for (int m = 0; m < model->motion_count; m++) {
        formula_destroy(model->motions[m].formula);
        mem_free(model->motions[m].vertices.items);
    }
    for (int k = 0; k < model->support_count; k++) mem_free(model->supports[k].points.items);
    for (int k = 0; k < model->written_count; k++) {
        mem_free(model->written[k].how);
        mem_free(model->written[k].where);
    }
    model_clear_probes(model);
    design_clear(&model->design);
    timed_clear(&model->flux_of_time);
    mesh_report_clear(&model->report);
    if (model->self) model->body->ops->destroy(model->self);
    mem_free(model->cases);
    mem_free(model->flux);
    mem_free(model->told_within);
    mem_free(model->motions);
    mem_free(model->written);
    mem_free(model->supports);
    mem_free(model->x);
    mem_free(model);
}
