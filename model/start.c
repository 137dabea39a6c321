#include "model/start.h"
#include "base/memory.h"
#include "model/scene_tables.h"
#include "model/state_arrays.h"
#include "model/stored.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

struct Start {
    Result *result;
    YamlFile *file;
    Scene scene; /* that the result was made from; without a body where it cannot be read */
    Array cases; /* names of its load cases, a line each */
};

static const char KEY[] = "start.result";

void start_close(Start *start)
{
    if (!start) return;
    yaml_clear(scene_table(), &start->scene);
    yaml_destroy(start->file);
    result_close(start->result);
    array_clear(&start->cases);
    mem_free(start);
}

/* ---- What the result is of ---- */

static const BodyRow *stored_body(const Start *start)
{
    int k = 0;
    while (bodies[k] && !start->scene.body[k]) k++;
    return bodies[k];
}

static bool is_unfinished(const Start *start)
{
    Array status;
    if (!result_read(start->result, "slender/status", &status, NULL)) return false;
    bool is = !strcmp(status.data, "unfinished");
    array_clear(&status);
    return is;
}

static bool refuse_stateless(const Start *start, const char *path, YamlFile *file)
{
    if (is_unfinished(start))
        return yaml_refuse(file, KEY,
                           "%s is of a run that has not ended: go on with it (--resume) to its end, or "
                           "interrupt it (Ctrl-C)",
                           path);
    if (result_has(start->result, "slender/case_names"))
        return yaml_refuse(file, KEY,
                           "%s is of an older slender, which kept places only: run its scene again", path);
    return yaml_refuse(
        file, KEY,
        "%s has no state to start from: its job leaves none, it is unsolved, or an older slender made it",
        path);
}

static bool check_body(const Start *start, const Model *model, const char *path, YamlFile *file)
{
    const BodyRow *body = stored_body(start);
    if (body && body != model->body)
        return yaml_refuse(file, KEY, "%s is a result of %s, and the scene has %s", path, body->noun,
                           model->body->noun);
    return result_has(start->result, "slender/state/dofs") ||
           result_has(start->result, "slender/frames/dofs") || refuse_stateless(start, path, file);
}

/* Is what tells a body from others the same as in the result? Lengths to rounding. */
static bool is_same(const Array *here, const Array *there)
{
    const double little = 1e-9;
    bool same = here->type == there->type && array_count(here) == array_count(there);
    if (!same || here->type == ARRAY_INT32)
        return same && !memcmp(here->data, there->data, array_bytes(here));
    const double *a = here->data, *b = there->data;
    double largest = 0;
    for (size_t i = 0; i < array_count(here); i++) largest = fmax(largest, fabs(a[i]));
    for (size_t i = 0; same && i < array_count(here); i++) same = fabs(a[i] - b[i]) <= little * largest;
    return same;
}

/* The row of what is not the same; NULL: all is. */
static const Likeness *find_difference(const Start *start, const Model *model)
{
    static const Likeness none = {0};
    const Likeness *row = model->body->ops->likeness ? model->body->ops->likeness : &none;
    Arrays list = {0};
    model->body->ops->add_static(model, &list);
    for (bool same = true; row->name; row++) {
        Array there;
        char *path = mem_format("slender/%s", row->name);
        same = result_read(start->result, path, &there, NULL);
        mem_free(path);
        if (!same) break;
        for (size_t k = 0; k < list.count; k++)
            if (!strcmp(list.arrays[k].name, row->name)) same = is_same(&list.arrays[k], &there);
        array_clear(&there);
        if (!same) break;
    }
    arrays_clear(&list);
    return row->name ? row : NULL;
}

/* ---- Which of its states ---- */

static bool has_case(const Start *start, const char *name)
{
    size_t size = strlen(name);
    const char *line = start->cases.data;
    for (size_t length; line && *line; line += length + (line[length] == '\n')) {
        length = strcspn(line, "\n");
        if (length == size && !strncmp(line, name, size)) return true;
    }
    return false;
}

/* "up, down" */
static char *list_cases(const Start *start)
{
    char *list = mem_text("");
    const char *line = start->cases.data ? start->cases.data : "";
    for (size_t length; *line; line += length + (line[length] == '\n')) {
        length = strcspn(line, "\n");
        char *name = mem_format("%s%.*s", *list ? ", " : "", (int)length, line);
        list = mem_join(list, name, "");
        mem_free(name);
    }
    return list;
}

static bool check_case(const Start *start, const StartScene *from, YamlFile *file)
{
    if (!from->load_case || has_case(start, from->load_case)) return true;
    char *list = list_cases(start);
    yaml_refuse(file, "start.case", "%s has no load case '%s'; it has %s", from->result, from->load_case,
                list);
    mem_free(list);
    return false;
}

static bool check_frame(const Start *start, const StartScene *from, YamlFile *file)
{
    int frame = from->frame.number, count = result_step_count(start->result);
    bool whole = result_has(start->result, "slender/frames/dofs");
    if (frame == YAML_ABSENT)
        return result_has(start->result, "slender/state/dofs") || refuse_stateless(start, from->result, file);
    if (from->load_case)
        return yaml_refuse(file, "start.case", "a frame is one state: give `case` or the number of a frame");
    if (frame >= count)
        return yaml_refuse(file, "start.frame", "%s has %d frames, from 0 on", from->result, count);
    return whole || frame == count - 1 ||
           yaml_refuse(file, "start.frame",
                       "%s keeps the whole state of its last frame only, which is %d: run its scene with "
                       "output.states: all",
                       from->result, count - 1);
}

/* Where the state is from which a case of that name starts; NULL: of a scene without `cases`. */
static StatePlace place_of(const Start *start, const StartScene *from, const char *name)
{
    StatePlace place = {.result = start->result, .prefix = "slender/state", .row = -1};
    int frame = from->frame.number;
    char *path = NULL;
    if (frame != YAML_ABSENT && result_has(start->result, "slender/frames/dofs")) {
        place.row = frame;
        path = mem_text("slender/frames");
    } else if (from->load_case || name) {
        path = mem_format("slender/cases/%s/state", from->load_case ? from->load_case : name);
    }
    char *dofs = mem_format("%s/dofs", path ? path : "");
    if (path && result_has(start->result, dofs)) snprintf(place.prefix, sizeof place.prefix, "%s", path);
    mem_free(dofs);
    mem_free(path);
    return place;
}

/* ---- Taking it ---- */

/* The loads that act there. */
static bool take_loads(const StatePlace *place, const Model *model, Case *c, Error *err)
{
    bool ok = true, has;
    c->loads = mem_alloc((size_t)model->params->size, sizeof *c->loads);
    for (int b = 0; ok && b < model->params->block_count; b++) {
        const ParamBlock *block = &model->params->blocks[b];
        char *name = mem_format("loads/%s", block->name);
        if (block->load)
            ok = state_arrays_get(place, name, (size_t)(block->count * block->width),
                                  c->loads + block->offset, &has, err);
        mem_free(name);
    }
    return ok;
}

/* What is held and not moved has no velocity; in statics there are none. */
static bool take_velocities(const StatePlace *place, const Model *model, Case *c, Error *err)
{
    State *state = &c->state;
    bool has;
    if (!model->job->motion && !model->general) return true;
    if (!state_arrays_get(place, "velocities", (size_t)state->dofs, state->v, &has, err)) return false;
    for (int i = 0; i < state->dofs && !model->moves; i++)
        if (system_is_fixed(c->sys, i)) state->v[i] = 0;
    return state_arrays_get(place, "time", 1, &state->time, &has, err);
}

static bool take_anchor(const StatePlace *place, const Model *model, Case *c, Error *err)
{
    size_t count = (size_t)system_anchor_count(c->sys);
    bool has = false;
    if (!model->job->motion) return true;
    c->anchor = mem_alloc(count, sizeof *c->anchor);
    bool ok = state_arrays_get(place, "anchor", count, c->anchor, &has, err);
    if (!has) mem_free(c->anchor), c->anchor = NULL;
    return ok;
}

/* What self contact and its friction remember is last, and as much for each. A state without it, or with more, will do: it is
 * where lists of pairs were made, and where a body has left that they are made anew. */
static bool take_memory(const StatePlace *place, const Model *model, State *state, Error *err)
{
    const World *world = model->world;
    int each = 3 * model->point_count, own = state->memory_count, has = 0;
    if (world && world->self) own -= each * (1 + (model->job->motion && world->rubs));
    Array stored;
    if (!state_arrays_find(place, "memory", &stored, err)) return false;
    if (stored.data) has = (int)array_count(&stored);
    bool met = result_has(place->result, "slender/design/self_stiffness"),
         fits = met ? has == own + each || has == own + 2 * each : has == own;
    int count = has < state->memory_count ? has : state->memory_count;
    if (fits && count) memcpy(state->memory, stored.data, (size_t)count * sizeof *state->memory);
    array_clear(&stored);
    return fits || error_set(err, "its energies remember other things");
}

static bool take_case(const StatePlace *place, const Model *model, Case *c, Error *err)
{
    const BodyOps *ops = model->body->ops;
    State *state = &c->state;
    Array dofs;
    if (!state_arrays_find(place, "dofs", &dofs, err)) return false;
    int count = (int)array_count(&dofs);
    bool ok = ops->take_state ? ops->take_state(model, dofs.data, count, state->x, err)
                              : count == state->dofs ||
                                    error_set(err, "its state has %d numbers, not %d", count, state->dofs);
    if (ok && !ops->take_state) memcpy(state->x, dofs.data, (size_t)count * sizeof *state->x);
    array_clear(&dofs);
    return ok && take_memory(place, model, state, err) && take_loads(place, model, c, err) &&
           take_velocities(place, model, c, err) && take_anchor(place, model, c, err);
}

/* Can the state of a run that ended with that status not be trusted? */
static bool is_doubtful(const char *status)
{
    static const char *const doubtful[] = {"pierced", "crushed", "tangled", "not_finite"};
    for (int k = 0; k < 4; k++)
        if (!strcmp(status, doubtful[k])) return true;
    return false;
}

/* What the run ended as, where its state cannot be trusted: nothing in the state itself tells. */
static void warn_end(Model *model, const char *path)
{
    Array status;
    if (!result_read(model->start->result, "slender/status", &status, NULL)) return;
    if (is_doubtful(status.data))
        mesh_warn(&model->report, "%s: %s ended as %s, and what starts from it has that in it", KEY, path,
                  (const char *)status.data);
    array_clear(&status);
}

bool start_take(Model *model, const Scene *scene, YamlFile *file)
{
    const StartScene *from = scene->start;
    if (!from) return true;
    const Likeness *difference = find_difference(model->start, model);
    if (difference) return yaml_refuse(file, KEY, "%s is of %s", from->result, difference->other);
    bool ok = true;
    for (int k = 0; ok && k < model->case_count; k++) {
        Error err;
        Case *c = &model->cases[k];
        StatePlace place = place_of(model->start, from, scene->cases_count ? c->name : NULL);
        ok = take_case(&place, model, c, &err) || yaml_refuse(file, KEY, "%s: %s", from->result, err.text);
    }
    if (ok) warn_end(model, from->result);
    return ok;
}

/* ---- The whole ---- */

/* A motion goes on from the state's time. */
static bool take_time(Model *model, const Scene *scene, YamlFile *file)
{
    StatePlace place = place_of(model->start, scene->start, NULL);
    Error err;
    bool has;
    if (!model->job->motion) return true;
    if (!state_arrays_get(&place, "time", 1, &model->time, &has, &err))
        return yaml_refuse(file, KEY, "%s", err.text);
    return scene->time.at == 0 ||
           yaml_refuse(file, "time.at", "%s goes on from the time of its start, %g s: leave `at` out",
                       model->job->noun, model->time);
}

bool start_open(Model *model, const Scene *scene, YamlFile *file)
{
    const StartScene *from = scene->start;
    Error err;
    if (!from) return true;
    Result *result = result_open(from->result, &err);
    if (!result) return yaml_refuse(file, KEY, "%s", err.text);
    Start *start = model->start = mem_alloc(1, sizeof *start);
    start->result = result;
    stored_result_scene(result, &start->file, &start->scene);
    if (result_has(result, "slender/case_names"))
        result_read_as(result, "slender/case_names", ARRAY_TEXT, 1, 0, &start->cases, NULL);
    return check_body(start, model, from->result, file) && check_case(start, from, file) &&
           check_frame(start, from, file) && take_time(model, scene, file);
}
