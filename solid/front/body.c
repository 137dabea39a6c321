/* The row of solids: models of them. */
#include "base/memory.h"
#include "job/jobs.h"
#include "solid/front/front.h"
#include "solid/front/mesh.h"
#include <math.h>
#include <string.h>

/* ---- Parameters ---- */

static double *base_params(Model *model, const Scene *scene, const Build *b)
{
    Solid *solid = model->self;
    double *p = params_vector(model->params);
    solid_default_params(solid, p);
    const SolidScene *s = solid_scene(scene);
    bool ok = build_numbers(b, key("solid.young"), 3, "Pa", &s->young, p + solid->young);
    ok =
        build_vectors(b, key("solid.magnetization"), 3, &s->magnetization, p + solid->volume_magnetization) &&
        ok;
    if (s->skin)
        ok = build_vectors(b, key("solid.skin.magnetization"), 2, &s->skin->magnetization,
                           p + solid->magnetization) &&
             ok;
    if (solid->film)
        ok = build_numbers(b, key("solid.skin.young"), 2, "Pa", s->skin->young, p + solid->skin_young) && ok;
    for (int f = 0; solid->skin_on && f < b->mesh->face_count; f++) /* what is not there is not shown */
        if (!solid->skin_on[f]) memset(p + solid->magnetization + 3 * f, 0, 3 * sizeof *p);
    memcpy(p + solid->gravity, s->gravity, sizeof s->gravity);
    p[solid->damping] = s->damping;
    ok = build_loads(b, key("loads"), scene->loads, scene->loads_count, p + solid->load) && ok;
    model_put_flux(model, 0, p);
    if (ok) return p;
    mem_free(p);
    return NULL;
}

/* ---- The whole ---- */

static System *make_system(const Model *model, bool motion)
{
    return solid_system(model->self, motion);
}

/* Faces of the surface that have the layer. */
static bool put_skin(Solid *solid, const Build *b, const SkinScene *skin)
{
    if (!skin || !skin->on) return true;
    const MeshGroup *group = build_group(b, key("solid.skin.on"), skin->on->group, 2);
    if (!group) return false;
    solid->skin_on = mem_alloc((size_t)b->mesh->face_count, sizeof *solid->skin_on);
    for (int k = 0; k < group->count; k++) solid->skin_on[group->members[k]] = true;
    return true;
}

static bool fill(Model *model, const Scene *scene, const Build *b, bool readable)
{
    Solid *solid = model->self;
    const SolidScene *from = solid_scene(scene);
    bool ok = put_skin(solid, b, from->skin) && readable;
    ok = model_hold(model, b, scene, solid->fixed, NULL) && ok;
    model->x = mem_copy(b->mesh->rest, (size_t)model->point_count, sizeof *b->mesh->rest);
    ok = build_pose(b, key("solid.pose"), from->pose, NULL, (double(*)[3])model->x) && ok;
    double *p = base_params(model, scene, b);
    ok = p && model_cases(model, b, scene, p) && ok;
    mem_free(p);
    return ok && model_start_cases(model, b, solid->fixed) &&
           (!model->job->motion ||
            model_velocity(model, b, "solid.velocity", from->velocity, b->mesh->rest[0]));
}

static const double MOST_AVERAGED =
    0.6; /* of quadratic tetrahedra: more, and they collapse when they are pressed */

static bool check(const SolidScene *from, YamlFile *file)
{
    if (from->poisson == 0.5)
        return yaml_refuse(
            file, "solid.poisson",
            "a Poisson's ratio of 0.5 forbids every change of volume, which positions of nodes cannot obey: "
            "take less, 0.49 at most for good results");
    const SkinScene *skin = from->skin;
    bool ok =
        !skin || !skin->young || !isnan(skin->poisson) ||
        yaml_refuse(file, "solid.skin.young", "a film needs its Poisson's ratio, too: solid.skin.poisson");
    ok = ok && (from->averaging == 0 || from->material == SOLID_NEO_HOOKEAN ||
                yaml_refuse(file, "solid.averaging", "averaging is for the material neo_hookean"));
    return ok &&
           (from->order == TET_LINEAR || from->averaging <= MOST_AVERAGED ||
            yaml_refuse(file, "solid.averaging",
                        "%g is too much: quadratic tetrahedra collapse under pressure with more than %g",
                        from->averaging, MOST_AVERAGED));
}

static bool create(Model *model, const Scene *scene, YamlFile *file)
{
    const SolidScene *from = solid_scene(scene);
    Tets *tets = check(from, file)
                     ? solid_read_mesh(&from->mesh, file, "solid.mesh", from->order, &model->report)
                     : NULL;
    if (!tets) return false;
    Build b = build_start(scene, tets->surface, model->time, file);
    b.mesh_scale = from->mesh.scale;
    b.report = &model->report;
    b.timed = model->job->motion ? &model->flux_of_time : NULL;
    FluxFields fields;
    bool ok = model_read_flux(model, &b, scene, &fields);
    SolidDef def = {.material = (SolidMaterial)from->material,
                    .poisson = from->poisson,
                    .density = from->density,
                    .averaging = from->averaging,
                    .skin = from->skin ? from->skin->thickness : 0,
                    .film = from->skin && from->skin->young,
                    .film_poisson = from->skin ? from->skin->poisson : NAN,
                    .film_material = from->skin ? (MembraneMaterial)from->skin->material : 0};
    Solid *solid = model->self = solid_create(tets, &def, &fields);
    solid->coercivity = from->coercivity;
    model->mesh = tets->surface;
    model->params = &solid->params;
    model->gravity = solid->gravity;
    model->flux_blocks = solid->flux;
    model->fields = &solid->fields;
    model->point_count = tets_node_count(tets);
    model->load_steps = 1;
    model->step_cap = newton_default().step_cap;
    WorldBody shown = solid_world_body(solid);
    ok = model_read_world(model, &b, scene, &shown, &solid->world) && ok;
    model_add_blocks(model, scene);
    return fill(model, scene, &b, ok);
}

static void destroy(void *self)
{
    solid_destroy(self);
}

/* ---- Designs ---- */

/* Of which elements a block has rows: what is of the skin has faces. */
static int row_dim(const Model *model, const ParamBlock *block)
{
    const Solid *solid = model->self;
    return block->offset == solid->magnetization || block->offset == solid->skin_young ? 2 : 3;
}

/* Faces without the layer have rows, too, so that they go by the surface's faces. */
static const bool *rows_on(const Model *model, const ParamBlock *block)
{
    return row_dim(model, block) == 2 ? ((const Solid *)model->self)->skin_on : NULL;
}

static Masses masses(const Model *model)
{
    return solid_masses(model->self);
}

/* ---- The row ---- */

static const Likeness likeness[] = {
    {"cells", "a mesh with other tetrahedra"}, {"rest", "a mesh of another shape at rest"}, {0}};

static const BodyOps ops = {
    .create = create,
    .destroy = destroy,
    .put_loads = model_put_loads,
    .put_target = model_put_target,
    .row_dim = row_dim,
    .rows_on = rows_on,
    .put_numbers = model_put_numbers,
    .put_vectors = model_put_vectors,
    .select = model_select,
    .masses = masses,
    .move = model_move_held,
    .system = make_system,
    .supports = model_supports,
    .add_static = solid_add_static,
    .add_frame = solid_add_frame,
    .add_state = solid_add_state,
    .add_stress = solid_add_stress,
    .add_final = run_add_stability,
    .likeness = likeness,
    .places = model_places,
    .doubt = solid_doubt,
    .crushed = solid_crushed,
    .crushed_as = NEWTON_TANGLED,
    .describe = solid_describe,
    .advise = solid_advise,
    .dof_sizes = solid_dof_sizes,
    .cost = solid_cost,
};

static const JobRow *const jobs[] = {&job_equilibrium, &job_evaluate,   &job_design,
                                     &job_simulate,    &job_trajectory, NULL};

const BodyRow solid_body = {
    .key = "solid",
    .noun = "a solid",
    .nouns = "solids",
    .doc = "the body: a solid",
    .table = &solid_table,
    .uses = (const KeyUse[]){{0}},
    .jobs = jobs,
    .ops = &ops,
};

const SolidScene *solid_scene(const Scene *scene)
{
    return scene_of(scene, &solid_body);
}
