#include "model/world_report.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "world/poses.h"
#include <math.h>

static const double INSIDE =
    0.02; /* of the thickness, beyond which a start within an obstacle is none that rests on it */
static const double OVERLAP =
    0.9; /* of the thickness: parts that meet only there reach into each other      */
static const double APART = 1e-3; /* of the distance: parts that begin nearer */
static const double SLOW = 0.1;   /* of the speed of a free fall by the body's size                         */

/* ---- What there is ---- */

static const double *first_params(const Model *model)
{
    return model->cases[0].stages[0].p;
}

/* Takes the line. */
static char *add_line(char *text, char *line)
{
    text = mem_join(text ? text : mem_text(""), line, "\n");
    mem_free(line);
    return text;
}

static char *obstacle_text(const Model *model, int k)
{
    const World *world = model->world;
    const Obstacle *obstacle = &world->obstacles[k];
    double friction = first_params(model)[world->friction + k];
    char *text = mem_format("%s (%s%s%s", obstacle->name, obstacle->ops->kind,
                            timed_is_given(&obstacle->motion.move) ? ", moves" : "",
                            timed_is_given(&obstacle->motion.turn) ? ", turns" : "");
    if (!model->job->motion || friction == 0) return mem_join(text, ")", "");
    char *rubs = mem_format(", friction %.3g)", friction);
    text = mem_join(text, rubs, "");
    mem_free(rubs);
    return text;
}

static char *obstacles_line(const Model *model)
{
    int count = model->world->obstacle_count;
    char *line = mem_format("%d obstacle%s:", count, count == 1 ? "" : "s");
    for (int k = 0; k < count; k++) {
        char *one = obstacle_text(model, k);
        line = mem_join(line, k ? ", " : " ", one);
        mem_free(one);
    }
    return line;
}

/* Of the body's points, and of the middles of what lies between them. */
static char *samples_text(const World *world)
{
    bool rod = world->body.face_count == 0;
    int count[SAMPLE_KINDS + 1] = {0};
    double detail = INFINITY;
    for (int k = 0; k < world->contact_kinds; k++)
        count[world->contacts[k].samples.corners] = world->contacts[k].samples.count;
    for (int k = 0; k < world->obstacle_count; k++) detail = fmin(detail, world->obstacles[k].feature);
    char *text = mem_format("%d %s", count[1], rod ? "nodes" : "vertices");
    if (count[2] == 0) return text;
    char *faces = rod ? mem_text("") : mem_format(" and %d faces", count[3]),
         *more = mem_format(", and middles of %d %s%s longer than an obstacle's detail of %.3g m", count[2],
                            rod ? "elements" : "edges", faces, detail);
    mem_free(faces);
    text = mem_join(text, more, "");
    mem_free(more);
    return text;
}

/* A distance that the body keeps: one, or from where it is thinnest to where it is thickest. */
static char *distance_text(const World *world, bool local, double largest)
{
    double least = local ? largest * world_thinnest(&world->body) : largest;
    return least < largest ? mem_format("%.3g to %.3g m", least, largest) : mem_format("%.3g m", largest);
}

static char *contact_line(const Model *model, const Scene *scene)
{
    const World *world = model->world;
    char *samples = samples_text(world), *away = distance_text(world, world->local, world->offset),
         *line = mem_format("contact: %s; the body stays %s away, with %.3g N/m at each%s", samples, away,
                            first_params(model)[world->stiffness],
                            scene->contact.stiffness.mode == 0 ? ", as follows from it" : "");
    mem_free(samples);
    mem_free(away);
    return line;
}

static char *water_line(const Model *model)
{
    const World *world = model->world;
    const double *p = first_params(model), *v = p + world->water.velocity;
    bool flows = world->flow || v[0] != 0 || v[1] != 0 || v[2] != 0;
    char *viscosity =
        world->body.face_count ? mem_text("") : mem_format(", %.3g Pa s", p[world->water.viscosity]);
    char *line = mem_format("water: %.4g kg/m^3%s%s%s", p[world->water.density], viscosity,
                            flows ? ", it flows" : "", world->outer ? ", on the outer sides of faces" : "");
    mem_free(viscosity);
    return line;
}

char *world_describe(const Model *model, const Scene *scene)
{
    const World *world = model->world;
    char *text = NULL;
    if (!world) return NULL;
    if (world->obstacle_count) {
        text = add_line(text, obstacles_line(model));
        text = add_line(text, contact_line(model, scene));
    }
    if (world->self) {
        const double *p = first_params(model);
        char *near = distance_text(world, world->self_local, world->distance);
        text = add_line(text, mem_format("self contact: parts nearer than %s, with %.3g J; friction %.3g",
                                         near, p[world->self_stiffness], p[world->self_friction]));
        mem_free(near);
    }
    if (world->wet) text = add_line(text, water_line(model));
    return text;
}

/* ---- What is doubtful ---- */

/* Where is the body deepest in an obstacle, and how deep with its outside, m? */
typedef struct Deepest {
    int vertex;
    double depth, outside;
} Deepest;

static Deepest deepest_in(const World *world, int obstacle, const RigidPose *pose, const Case *c)
{
    Deepest deepest = {.depth = -INFINITY};
    for (int e = 0; e < world->contacts[0].samples.count; e++) {
        Gap gap;
        int v = world_vertex(world, e);
        double outside = world_offset(world, e, c->stages[0].p);
        obstacle_gap(&world->obstacles[obstacle], pose, c->state.x + world->body.first + 3 * v, &gap);
        if (outside - gap.value > deepest.depth) deepest = (Deepest){v, outside - gap.value, outside};
    }
    return deepest;
}

static void advise_start(Model *model, const Case *c)
{
    const World *world = model->world;
    Poses poses = poses_create(world->obstacles, world->obstacle_count);
    poses_update(&poses, &(Point){.time = c->state.time});
    for (int k = 0; k < world->obstacle_count; k++) {
        Deepest at = deepest_in(world, k, &poses.end[k], c);
        double part = world->local ? at.outside / world->offset : 1; /* of the largest thickness */
        if (at.depth > INSIDE * part * world->body.thickness)
            mesh_warn(&model->report,
                      "where %s starts, the body is inside the obstacle '%s': %s %d by %.3g m (its outside "
                      "is %.3g m off). It is driven out at once",
                      c->name, world->obstacles[k].name, world->body.face_count ? "vertex" : "node",
                      at.vertex, at.depth, at.outside);
    }
    poses_destroy(&poses);
}

/* Nearer than any press brings them. */
static void advise_near(Model *model, const Case *c)
{
    const World *world = model->world;
    int vertices[2];
    double distance = world_nearest(world, c->state.x, APART, vertices);
    if (isfinite(distance))
        mesh_warn(&model->report,
                  "where %s starts, parts of the body are %.3g m apart, at %s %d and %d, and self contact "
                  "begins at %.3g m. They are driven apart at once",
                  c->name, distance, world->body.face_count ? "vertices" : "nodes", vertices[0], vertices[1],
                  world->distance);
}

/* N s/m of all of the body: its points have a damping each, rods one for each metre. */
static double damping_of_all(const Model *model, double damping)
{
    const WorldBody *body = &model->world->body;
    double length = 0;
    for (int k = 0; k < body->strands; k++) length += body->length[k];
    return damping * (body->strands ? length : model->point_count);
}

/* What falls comes to the speed at which that bears the weight. */
static void advise_damping(Model *model)
{
    const ParamBlock *block = params_find(model->params, "damping");
    const double *p = first_params(model);
    if (!block || model->gravity < 0 || !model->job->motion || !model->body->ops->masses) return;
    double *mass = mem_alloc((size_t)model->point_count, sizeof *mass), sum = 0, size = 0,
           g = vec3_length(vec3_load(p + model->gravity)), damping = p[block->offset];
    const WorldBody *body = &model->world->body;
    model_masses(model, p, mass);
    for (int v = 0; v < model->point_count; v++) {
        sum += mass[v];
        size = fmax(size, vec3_length(vec3_sub(vec3_load(body->rest[v]), vec3_load(body->rest[0]))));
    }
    mem_free(mass);
    double speed = sum * g / damping_of_all(model, damping), fall = sqrt(2 * g * size);
    if (damping > 0 && g > 0 && speed < SLOW * fall)
        mesh_warn(&model->report,
                  "damping outweighs all else: with %.3g %s%s the body falls at %.2g m/s at most", damping,
                  block->unit, body->strands ? "" : " at each point", speed);
}

/* What is smaller than a quarter of an edge fits between vertices and the middles of edges and faces. */
static void advise_mesh(Model *model)
{
    const World *world = model->world;
    double longest = world_longest_edge(world, world->body.rest[0]);
    for (int k = 0; k < world->obstacle_count; k++)
        if (world_slips_between(world, k, longest))
            mesh_warn(&model->report,
                      "obstacle '%s' has details of %.3g m, and the body edges of up to %.3g m: it may pass "
                      "between the places where contact is felt (vertices, middles of edges and faces); a "
                      "finer mesh would "
                      "not let it",
                      world->obstacles[k].name, world->obstacles[k].feature, longest);
}

void world_advise(Model *model)
{
    const World *world = model->world;
    if (!world) return;
    advise_mesh(model);
    for (int k = 0; k < model->case_count; k++) advise_start(model, &model->cases[k]);
    for (int k = 0; world->self && k < model->case_count; k++) advise_near(model, &model->cases[k]);
    if (world->self && world->distance < OVERLAP * world->body.thickness)
        mesh_warn(
            &model->report,
            "self contact begins where middles are %.3g m apart, but the body is %.3g m thick: its parts "
            "reach into each other",
            world->distance, world->body.thickness);
    if (world->obstacle_count) advise_damping(model);
}
