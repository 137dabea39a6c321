#include "cli/model.h"
#include "base/memory.h"
#include "cli/build.h"
#include "cli/job.h"
#include "shell/rigid.h"
#include "shell/shapes.h"
#include <math.h>
#include <string.h>

/* ---- The mesh ---- */

static bool generate(const MeshScene *scene, YamlFile *yaml, MeshFile *file)
{
    Error err;
    double size[2] = {scene->size[0], scene->size_count > 1 ? scene->size[1] : scene->size[0]};
    bool ok = false;
    switch ((MeshShape)scene->shape) {
    case MESH_SHEET:
        ok = shape_sheet(size, scene->cells, (ShapePattern)scene->pattern, file, &err);
        break;
    case MESH_STRIP:
        ok = shape_strip(size[0], size[1], scene->n, (ShapePattern)scene->pattern, file, &err);
        break;
    case MESH_HEXAGRAM:
        ok = shape_hexagram(size[0], scene->n, file, &err);
        break;
    case MESH_DISC:
        ok = shape_disc(size[0], scene->n, file, &err);
        break;
    case MESH_KIRIGAMI:
        ok = shape_kirigami(size[0], scene->n, file, &err);
        break;
    }
    return ok || yaml_refuse(yaml, "shell.mesh", "%s", err.text);
}

/* What each shape needs, in one sentence. */
static bool check_shape(const MeshScene *scene, YamlFile *yaml)
{
    bool rectangle = scene->shape == MESH_SHEET || scene->shape == MESH_STRIP;
    if (scene->size_count != (rectangle ? 2 : 1))
        return yaml_refuse(yaml, "shell.mesh", "a %s needs `size`: %s",
                           rectangle ? "sheet or strip" : "hexagram, disc or kirigami",
                           rectangle ? "its length and width, e.g. [65 mm, 65 mm]"
                                     : "its diameter or side, e.g. 40 mm");
    if (scene->shape == MESH_SHEET && scene->cells_count != 2)
        return yaml_refuse(yaml, "shell.mesh", "a sheet needs `cells` along x and y, e.g. [64, 64]");
    if (scene->shape != MESH_SHEET && scene->n == YAML_ABSENT)
        return yaml_refuse(yaml, "shell.mesh",
                           "a strip, hexagram, disc or kirigami needs `n`, the number of its divisions");
    return true;
}

static bool read_mesh_file(const MeshScene *scene, YamlFile *yaml, MeshFile *file)
{
    if (!scene->file) return check_shape(scene, yaml) && generate(scene, yaml, file);
    Error err;
    if (!mesh_file_read(scene->file, file, &err)) return yaml_refuse(yaml, "shell.mesh.file", "%s", err.text);
    for (int i = 0; i < 3 * file->vertex_count; i++) file->vertices[i / 3][i % 3] *= scene->scale;
    return true;
}

static Mesh *build_mesh(const MeshScene *scene, YamlFile *yaml, MeshReport *report)
{
    MeshFile file = {0};
    Error err;
    Mesh *mesh = NULL;
    if (read_mesh_file(scene, yaml, &file)) {
        mesh = mesh_create(&file, scene->weld, report, &err);
        if (!mesh) yaml_refuse(yaml, "shell.mesh", "%s", err.text);
    }
    mesh_file_clear(&file);
    return mesh;
}

/* ---- What is held ---- */

static bool add_motion(Model *model, const Build *b, Key at, const FixScene *fix, const bool *axis,
                       Indices vertices)
{
    Motion motion = {.vertices = vertices, .axis = {axis[0], axis[1], axis[2]}};
    motion.formula = build_formula(b, at, fix->move, 3, NULL, 0, build_variables_time);
    if (!motion.formula) return false;
    size_t count = (size_t)model->motion_count++;
    model->motions = mem_resize(model->motions, count, count + 1, sizeof *model->motions);
    motion.vertices.items = mem_copy(vertices.items, (size_t)vertices.count, sizeof(int));
    model->motions[count] = motion;
    return true;
}

static bool fix_entry(Model *model, const Build *b, Key at, const FixScene *fix)
{
    bool axis[3] = {false};
    for (const char *c = fix->axes; *c; c++) {
        if (!strchr("xyz", *c))
            return yaml_refuse(b->file, at.text, "axes is '%s'; it must be some of xyz", fix->axes);
        axis[*c - 'x'] = true;
    }
    Indices found = {0};
    SelectionScene selection = SELECTION_OF(fix);
    bool ok = build_selection(b, at, &selection, &found);
    for (int i = 0; i < 3 * found.count; i++)
        if (axis[i % 3]) shell_fix(model->shell, found.items[i / 3], i % 3);
    if (ok && fix->clamp) {
        Indices edges = select_edges(b->mesh, &found);
        for (int k = 0; k < edges.count; k++) shell_clamp(model->shell, edges.items[k]);
        mem_free(edges.items);
    }
    if (ok && fix->move_count) ok = add_motion(model, b, key("%s.move", at.text), fix, axis, found);
    mem_free(found.items);
    return ok;
}

bool model_move(const Model *model, double time, double part, double *x, Error *err)
{
    for (int m = 0; m < model->motion_count; m++) {
        const Motion *motion = &model->motions[m];
        for (int k = 0; k < motion->vertices.count; k++) {
            int v = motion->vertices.items[k];
            double variables[BUILD_VARIABLES], place[3];
            build_position(variables, model->shell->mesh->rest[v], time);
            if (!formula_eval(motion->formula, variables, place, err)) return false;
            for (int i = 0; i < 3; i++)
                if (motion->axis[i]) x[3 * v + i] += part * (place[i] - x[3 * v + i]);
        }
    }
    return true;
}

bool model_load(const Model *model, double time, double *p, Error *err)
{
    const TimedFlux *timed = &model->flux_of_time;
    return !timed_flux_is_given(timed) || timed_flux_eval(timed, time, p + model->shell->flux_density, err);
}

/* ---- Loads of a case ---- */

static bool put_flux(Model *model, const Build *b, Key at, const FluxScene *flux, double *p)
{
    int field;
    Shell *shell = model->shell;
    if (!build_flux(b, at, flux, shell, p + shell->flux_density, &field)) return false;
    for (int k = 0; k < shell->field_count; k++) p[shell->field_scale + k] = k == field;
    return true;
}

/* Fields grow the parameter vector, so every p is made as large as it may become. */
static size_t params_room(const Model *model, const Scene *scene)
{
    return (size_t)(model->shell->params.size + 1 + scene->cases_count + scene->sequence_count);
}

static double *base_params(Model *model, const Scene *scene, const Build *b, size_t room)
{
    Shell *shell = model->shell;
    double *p = mem_alloc(room, sizeof *p);
    shell_default_params(shell, p);
    const ShellScene *s = &scene->shell;
    bool ok = build_face_numbers(b, key("shell.young"), &s->young, p + shell->young);
    ok = build_edge_numbers(b, key("shell.fold"), &s->fold, p + shell->fold) && ok;
    ok = build_face_vectors(b, key("shell.magnetization"), &s->magnetization, p + shell->magnetization) && ok;
    memcpy(p + shell->gravity, s->gravity, sizeof s->gravity);
    p[shell->damping] = s->damping;
    ok = build_loads(b, key("loads"), scene->loads, scene->loads_count, p + shell->load) && ok;
    if (ok && put_flux(model, b, key("flux_density"), &scene->flux_density, p)) return p;
    mem_free(p);
    return NULL;
}

/* Field, loads and gravity of a case or stage, where it says them. */
static bool put_loads(Model *model, const Build *b, Key at, const FluxScene *flux, const LoadScene *loads,
                      int count, const double *gravity, double *p)
{
    const Shell *shell = model->shell;
    if (!isnan(gravity[0])) memcpy(p + shell->gravity, gravity, 3 * sizeof *gravity);
    bool ok = !loads || build_loads(b, key("%s.loads", at.text), loads, count, p + shell->load);
    return (!flux || put_flux(model, b, key("%s.flux_density", at.text), flux, p)) && ok;
}

static ModelCase *add_case(Model *model, const char *name, const double *p, size_t room, double time)
{
    size_t count = (size_t)model->case_count++;
    model->cases = mem_resize(model->cases, count, count + 1, sizeof *model->cases);
    ModelCase *c = &model->cases[count];
    *c = (ModelCase){
        .name = name ? mem_text(name) : mem_format("case%zu", count + 1), .weight = 1, .stage_count = 1};
    c->stages = mem_alloc(1, sizeof *c->stages);
    c->stages[0] = (Stage){mem_copy(p, room, sizeof *p), time};
    return c;
}

static bool add_target(const Build *b, Key at, const TargetScene *target, ModelCase *c)
{
    if (!target) return true;
    c->target = mem_alloc((size_t)b->mesh->vertex_count, sizeof *c->target);
    return build_target(b, at, target, c->target);
}

static bool add_stages(Model *model, const Build *b, const Scene *scene, const double *p, size_t room)
{
    ModelCase *c = add_case(model, "sequence", p, room, scene->time.at);
    c->stages = mem_resize(c->stages, 1, (size_t)scene->sequence_count, sizeof *c->stages);
    c->stage_count = scene->sequence_count;
    bool ok = true;
    for (int k = 0; k < scene->sequence_count; k++) {
        const StageScene *stage = &scene->sequence[k];
        Build now = *b;
        if (k > 0)
            c->stages[k] = (Stage){mem_copy(c->stages[k - 1].p, room, sizeof *p), c->stages[k - 1].time};
        if (!isnan(stage->time)) c->stages[k].time = stage->time;
        now.time = c->stages[k].time;
        ok = put_loads(model, &now, key("sequence[%d]", k), stage->flux_density, stage->loads,
                       stage->loads_count, stage->gravity, c->stages[k].p) &&
             ok;
    }
    return ok;
}

static bool add_cases(Model *model, const Build *b, const Scene *scene, const double *p, size_t room)
{
    if (scene->sequence_count && scene->cases_count)
        return yaml_refuse(b->file, "sequence", "a scene has either cases or a sequence");
    if (scene->sequence_count) return add_stages(model, b, scene, p, room);
    bool ok = true;
    for (int k = 0; k < scene->cases_count; k++) {
        const CaseScene *from = &scene->cases[k];
        ModelCase *c = add_case(model, from->name, p, room, scene->time.at);
        c->weight = from->weight;
        Key at = key("cases[%d]", k);
        for (int i = 0; i < k; i++)
            if (!strcmp(model->cases[i].name, c->name))
                ok = yaml_refuse(b->file, at.text, "there are two cases named '%s'", c->name);
        if (strchr(c->name, '/') || !*c->name)
            ok = yaml_refuse(b->file, at.text, "a case's name is a word without '/'");
        ok = put_loads(model, b, at, from->flux_density, from->loads, from->loads_count, from->gravity,
                       c->stages[0].p) &&
             ok;
        bool own = from->target != NULL;
        ok = add_target(b, own ? key("%s.target", at.text) : key("target"),
                        own ? from->target : scene->target, c) &&
             ok;
    }
    if (!scene->cases_count)
        ok = add_target(b, key("target"), scene->target, add_case(model, NULL, p, room, scene->time.at));
    return ok;
}

/* ---- The whole ---- */

static bool read_pose(const Build *b, const PoseScene *pose, double *x)
{
    if (!pose) return true;
    const Mesh *mesh = b->mesh;
    MeshFile file = {0};
    Error err;
    if (!mesh_file_read(pose->file, &file, &err))
        return yaml_refuse(b->file, "shell.pose.file", "%s", err.text);
    bool ok = file.vertex_count == mesh->file_vertex_count && file.face_count == mesh->face_count;
    for (int f = 0; ok && f < mesh->face_count; f++)
        for (int i = 0; i < 3; i++) ok = ok && mesh->vertex_of_file[file.faces[f][i]] == mesh->faces[f][i];
    if (!ok)
        yaml_refuse(b->file, "shell.pose.file", "%s has other vertices or faces than the mesh", pose->file);
    for (int v = 0; ok && v < mesh->vertex_count; v++)
        memcpy(x + 3 * v, file.vertices[mesh->file_vertex[v]], 3 * sizeof *x);
    mesh_file_clear(&file);
    return ok;
}

static bool is_motion(int job)
{
    return job == JOB_SIMULATE || job == JOB_TRAJECTORY;
}

/* Of the free coordinates. */
static bool read_velocity(Model *model, const Build *b, const VelocityScene *scene)
{
    const Shell *shell = model->shell;
    Key at = key("shell.velocity");
    Error err;
    model->v = mem_alloc((size_t)shell_dof_count(shell), sizeof *model->v);
    if (!scene) return true;
    Formula *formula = NULL;
    if (scene->formula)
        formula = build_formula(b, at, scene->formula, 3, scene->where, scene->where_count, build_variables);
    bool ok = formula || !scene->formula;
    for (int v = 0; ok && v < b->mesh->vertex_count; v++) {
        double variables[BUILD_VARIABLES], speed[3];
        memcpy(speed, scene->value, sizeof speed);
        build_position(variables, b->mesh->rest[v], 0);
        if (formula && !formula_eval(formula, variables, speed, &err))
            ok = yaml_refuse(b->file, at.text, "%s", err.text);
        for (int i = 0; i < 3; i++) model->v[3 * v + i] = shell->fixed[3 * v + i] ? 0 : speed[i];
    }
    formula_destroy(formula);
    return ok;
}

/* Systems last: fields and what is held are known by then. An equilibrium needs forces in balance. */
static bool finish_cases(Model *model, const Build *b, JobKind job)
{
    bool ok = true, balanced = job == JOB_EQUILIBRIUM || job == JOB_DESIGN;
    for (int k = 0; ok && k < model->case_count; k++) {
        ModelCase *c = &model->cases[k];
        Error err;
        c->sys = is_motion(job) ? shell_dynamic_system(model->shell) : shell_system(model->shell);
        c->x = mem_copy(model->x, (size_t)shell_dof_count(model->shell), sizeof *c->x);
        system_accept(c->sys, c->x);
        for (int s = 0; ok && balanced && s < c->stage_count; s++)
            ok = rigid_check_force(model->shell, c->stages[s].p, &err) ||
                 yaml_refuse(b->file, "", "%s", err.text);
    }
    return ok;
}

static bool check_motion(const Scene *scene, YamlFile *file)
{
    const char *what = scene->job == JOB_SIMULATE ? "simulation" : "trajectory";
    if (!is_motion(scene->job))
        return !scene->shell.velocity ||
               yaml_refuse(file, "shell.velocity",
                           "velocities are for jobs in time: simulate and trajectory");
    if (isnan(scene->time.step) || scene->time.steps == YAML_ABSENT)
        return yaml_refuse(file, "time", "a %s needs `time`, e.g. time: {step: 1 ms, steps: 100}", what);
    return (!scene->cases_count && !scene->sequence_count) ||
           yaml_refuse(file, "job", "a %s has neither cases nor a sequence; a field may be a formula of t",
                       what);
}

static bool fill(Model *model, const Scene *scene, const Build *b)
{
    Shell *shell = model->shell;
    shell->thickness = scene->shell.thickness;
    shell->poisson = scene->shell.poisson;
    shell->density = scene->shell.density;
    shell->bending = (BendingModel)scene->shell.bending;
    bool ok = true;
    for (int k = 0; k < scene->fix_count; k++)
        ok = fix_entry(model, b, key("fix[%d]", k), &scene->fix[k]) && ok;
    model->x = mem_alloc((size_t)shell_dof_count(shell), sizeof *model->x);
    shell_rest_state(shell, model->x);
    ok = read_pose(b, scene->shell.pose, model->x) && ok;
    ok = read_velocity(model, b, scene->shell.velocity) && ok;
    size_t room = params_room(model, scene);
    double *p = base_params(model, scene, b, room);
    ok = p && add_cases(model, b, scene, p, room) && ok;
    mem_free(p);
    return ok && check_motion(scene, b->file) && finish_cases(model, b, (JobKind)scene->job);
}

Model *model_create(const Scene *scene, YamlFile *file)
{
    Model *model = mem_alloc(1, sizeof *model);
    Mesh *mesh = build_mesh(&scene->shell.mesh, file, &model->report);
    if (mesh) {
        model->shell = shell_create(mesh);
        Build b = {file, mesh, scene->time.at, is_motion(scene->job) ? &model->flux_of_time : NULL};
        bool designed = scene->job == JOB_DESIGN || scene->job == JOB_TRAJECTORY;
        if (fill(model, scene, &b) && (!designed || model_design(model, scene, file))) return model;
    }
    model_destroy(model);
    return NULL;
}

static void clear_case(ModelCase *c)
{
    for (int s = 0; s < c->stage_count; s++) mem_free(c->stages[s].p);
    for (int k = 0; k < c->objective_count; k++) objective_destroy(c->objectives[k]);
    system_destroy(c->sys);
    mem_free(c->name);
    mem_free(c->x);
    mem_free(c->stages);
    mem_free(c->objectives);
    mem_free(c->target);
}

void model_destroy(Model *model)
{
    if (!model) return;
    for (int k = 0; k < model->case_count; k++) clear_case(&model->cases[k]);
    for (int m = 0; m < model->motion_count; m++) {
        formula_destroy(model->motions[m].formula);
        mem_free(model->motions[m].vertices.items);
    }
    design_clear(&model->design);
    timed_flux_clear(&model->flux_of_time);
    mesh_report_clear(&model->report);
    shell_destroy(model->shell);
    mem_free(model->cases);
    mem_free(model->motions);
    mem_free(model->x);
    mem_free(model->v);
    mem_free(model);
}
