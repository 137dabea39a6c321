/* The row of shells: models of them. */
#include "base/memory.h"
#include "job/jobs.h"
#include "shell/front/front.h"
#include "shell/smoothness.h"
#include <math.h>
#include <string.h>

/* ---- Parameters ---- */

/* The largest of so many. */
static double largest_of(const double *values, int count)
{
    double largest = values[0];
    for (int i = 1; i < count; i++) largest = fmax(largest, values[i]);
    return largest;
}

static double *base_params(Model *model, const Scene *scene, const Build *b, const double *thickness)
{
    Shell *shell = model->self;
    double *p = params_vector(model->params);
    shell_default_params(shell, p);
    const ShellScene *s = shell_scene(scene);
    bool ok = build_numbers(b, key("shell.young"), 2, "Pa", &s->young, p + shell->young);
    ok = build_numbers(b, key("shell.density"), 2, "kg/m^3", &s->density, p + shell->face_density) && ok;
    memcpy(p + shell->face_thickness, thickness, (size_t)shell->mesh->face_count * sizeof *p);
    ok = build_numbers(b, key("shell.fold"), 1, "", &s->fold, p + shell->fold) && ok;
    ok = build_vectors(b, key("shell.magnetization"), 2, &s->magnetization, p + shell->magnetization) && ok;
    memcpy(p + shell->gravity, s->gravity, sizeof s->gravity);
    p[shell->damping] = s->damping;
    ok = build_loads(b, key("loads"), scene->loads, scene->loads_count, p + shell->load) && ok;
    model_put_flux(model, 0, p);
    if (ok) return p;
    mem_free(p);
    return NULL;
}

/* ---- The whole ---- */

/* A corner may be any of the vertices that were joined into the mesh's. */
static bool is_vertex(const Mesh *mesh, const MeshFile *file, int corner, int vertex)
{
    if (corner < 0 || corner >= file->vertex_count) return false;
    return (file->vertex_count == mesh->vertex_count ? corner : mesh->vertex_of_file[corner]) == vertex;
}

static bool has_same_faces(const Mesh *mesh, const MeshFile *file)
{
    bool same = mesh_fits(mesh, file->vertex_count) && file->face_count == mesh->face_count;
    for (int f = 0; same && f < mesh->face_count; f++)
        for (int i = 0; i < 3; i++)
            same = same && is_vertex(mesh, file, file->faces[f][i], mesh->faces[f][i]);
    return same;
}

static System *make_system(const Model *model, bool motion)
{
    return motion ? shell_dynamic_system(model->self) : shell_system(model->self);
}

static bool fill(Model *model, const Scene *scene, const Build *b, const double *thickness, bool readable)
{
    Shell *shell = model->self;
    const ShellScene *from = shell_scene(scene);
    bool ok = readable;
    ok = model_hold(model, b, scene, shell->fixed, shell->clamped) && ok;
    model->x = mem_alloc((size_t)shell_dof_count(shell), sizeof *model->x);
    shell_rest_state(shell, model->x);
    ok = build_pose(b, key("shell.pose"), from->pose, has_same_faces, (double(*)[3])model->x) && ok;
    double *p = base_params(model, scene, b, thickness);
    ok = p && model_cases(model, b, scene, p) && ok;
    mem_free(p);
    return ok && model_start_cases(model, b, shell->fixed) &&
           (!model->job->motion ||
            model_velocity(model, b, "shell.velocity", from->velocity, b->mesh->rest[0]));
}

/* The world meets each face's own, where these are not the same, now or later. */
static double *outsides_of(const Scene *scene, const double *thickness, int count)
{
    bool same = !scene->design || !scene->design->unknowns.thickness;
    for (int f = 1; f < count; f++) same = same && thickness[f] == thickness[0];
    if (same) return NULL;
    double *outsides = mem_alloc((size_t)count, sizeof *outsides);
    for (int f = 0; f < count; f++) outsides[f] = thickness[f] / 2;
    return outsides;
}

static void set_material(Shell *shell, const ShellScene *from)
{
    shell->poisson = from->poisson;
    shell->coercivity = from->coercivity;
    shell->material = (MembraneMaterial)from->material;
    shell->bending = (BendingModel)from->bending;
}

static bool create(Model *model, const Scene *scene, YamlFile *file)
{
    Mesh *mesh = build_mesh(&shell_scene(scene)->mesh, file, "shell.mesh", &model->report);
    if (!mesh) return false;
    Build b = build_start(scene, mesh, model->time, file);
    b.mesh_scale = shell_scene(scene)->mesh.scale;
    b.report = &model->report;
    b.timed = model->job->motion ? &model->flux_of_time : NULL;
    FluxFields fields;
    bool ok = model_read_flux(model, &b, scene, &fields);
    Shell *shell = model->self = shell_create(mesh, &fields);
    double *thickness = mem_alloc((size_t)mesh->face_count, sizeof *thickness);
    bool thick = build_numbers(&b, key("shell.thickness"), 2, "m", &shell_scene(scene)->thickness, thickness);
    shell->thickness = thick ? largest_of(thickness, mesh->face_count) : mesh_mean_edge(mesh);
    if (thick) shell->outsides = outsides_of(scene, thickness, mesh->face_count);
    set_material(shell, shell_scene(scene));
    model->mesh = mesh;
    model->params = &shell->params;
    model->gravity = shell->gravity;
    model->flux_blocks = shell->flux;
    model->fields = &shell->fields;
    model->point_count = mesh->vertex_count;
    model->load_steps = 1;
    model->step_cap = newton_default().step_cap;
    WorldBody shown = shell_world_body(shell);
    ok = model_read_world(model, &b, scene, &shown, &shell->world) && ok;
    model_add_blocks(model, scene);
    ok = fill(model, scene, &b, thickness, ok && thick);
    mem_free(thickness);
    return ok;
}

static void destroy(void *self)
{
    shell_destroy(self);
}

/* ---- Designs ---- */

/* Of which elements a block has rows. */
static int row_dim(const Model *model, const ParamBlock *block)
{
    return block->offset == ((const Shell *)model->self)->fold ? 1 : 2;
}

static Masses masses(const Model *model)
{
    return shell_masses(model->self);
}

static Objective smoothness(const Model *model, const ParamBlock *block, double weight)
{
    return shell_smoothness(model->self, block, weight);
}

/* Of edge angles, with all positions held. */
static System *pose_system(const Model *model)
{
    Shell *shell = model->self;
    size_t positions = 3 * (size_t)shell->mesh->vertex_count;
    bool *fixed = mem_copy(shell->fixed, positions, sizeof *fixed);
    for (size_t i = 0; i < positions; i++) shell->fixed[i] = true;
    System *held = shell_system(shell);
    memcpy(shell->fixed, fixed, positions * sizeof *fixed);
    mem_free(fixed);
    return held;
}

/* ---- The row ---- */

static const Likeness likeness[] = {
    {"faces", "a mesh with other faces"}, {"rest", "a mesh of another shape at rest"}, {0}};

static const BodyOps ops = {
    .create = create,
    .destroy = destroy,
    .put_loads = model_put_loads,
    .put_target = model_put_target,
    .row_dim = row_dim,
    .put_numbers = model_put_numbers,
    .put_vectors = model_put_vectors,
    .select = model_select,
    .masses = masses,
    .smoothness = smoothness,
    .move = model_move_held,
    .system = make_system,
    .supports = model_supports,
    .pose_system = pose_system,
    .add_static = shell_add_static,
    .add_frame = shell_add_frame,
    .add_state = shell_add_state,
    .add_stress = shell_add_stress,
    .add_final = run_add_stability,
    .likeness = likeness,
    .places = model_places,
    .doubt = shell_doubt,
    .crushed = shell_crushed,
    .crushed_as = NEWTON_CRUSHED,
    .describe = shell_describe,
    .advise = shell_advise,
    .dof_sizes = shell_dof_sizes,
    .cost = shell_cost,
};

static const JobRow *const jobs[] = {&job_equilibrium, &job_evaluate,   &job_design,
                                     &job_simulate,    &job_trajectory, NULL};

const BodyRow shell_body = {
    .key = "shell",
    .noun = "a shell",
    .nouns = "shells",
    .doc = "the body: a shell",
    .table = &shell_table,
    .uses = (const KeyUse[]){{0}},
    .jobs = jobs,
    .ops = &ops,
};
