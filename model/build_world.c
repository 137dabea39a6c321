/* What a body meets: of a scene, and the numbers that follow from the body. */
#include "base/memory.h"
#include "base/vec3.h"
#include "model/model.h"
#include <math.h>
#include <string.h>

/* Parts of world_body_measure: what presses with so many vertices' weights on one, falls by the body's own size and is
 * stopped in a step, or bears a load, sinks in by no more than SUNK beside the half percent of the penalty's smooth
 * beginning. */
static const double SUNK = 0.005, WEIGHTS = 50;
static const double PRESSED = 30; /* times Y h: the least stiffness of a shell's sample */

/* The least of a rod's: it is pressed by no more than what bends it to ten radii r within an element, Y I/(10 r l). Stiffer
 * ones cost Newton's method: hair that falls on a head takes 12 iterations a step by the shell's rule, 7 by this one. */
static const double BENT = 0.1 * M_PI / 4;

static FluxField *read_flow(const Build *b, const StreamScene *scene, bool *ok)
{
    if (!scene->formula) return NULL;
    Formula *formula = build_formula(b, key("water.velocity.formula"), scene->formula, 3, scene->where,
                                     scene->where_count, build_variables_time);
    *ok = formula != NULL;
    return formula ? flux_field_formula(formula, b->size) : NULL;
}

/* A face with one outer side is one of a surface with an inside, in which there is no water. */
static bool check_closed(const Build *b)
{
    const Mesh *mesh = b->mesh;
    for (int e = 0; e < mesh->edge_count; e++)
        if (mesh_edge_is_boundary(mesh, e))
            return yaml_refuse(b->file, "water.sides",
                               "outer is for closed surfaces, with no water inside, and the edge of vertices "
                               "%d and %d has one face only: take two, by which both sides feel the stream",
                               mesh->file_vertex[mesh->edges[e][0]], mesh->file_vertex[mesh->edges[e][1]]);
    return true;
}

/* What is switched off has no use for more. */
static bool check_self(const SelfContactScene *self, YamlFile *file)
{
    static const char ENABLED[] = "contact.self.enabled";
    return self->enabled || (isnan(self->distance) && isnan(self->stiffness)) || !yaml_says(file, ENABLED) ||
           yaml_refuse(file, ENABLED, "false leaves `distance` and `stiffness` without use: leave them out");
}

bool model_read_world(Model *model, const Build *b, const Scene *scene, const WorldBody *body, World **world)
{
    const ContactScene *contact = &scene->contact;
    bool self = self_contact_is_asked(&contact->self), ok = true;
    *world = NULL;
    if (!check_self(&contact->self, b->file)) return false;
    if (!scene->obstacles_count && !self && !scene->water) return true;
    Obstacle *obstacles;
    if (!build_obstacles(b, scene->obstacles, scene->obstacles_count, &obstacles)) {
        for (int k = 0; k < scene->obstacles_count; k++) obstacle_clear(&obstacles[k]);
        mem_free(obstacles);
        return false;
    }
    World *w = *world = world_create(body, obstacles, scene->obstacles_count);
    model->world = w;
    w->offset = contact->offset.mode == 0 ? body->outside : contact->offset.value;
    w->local = contact->offset.mode == 0 && body->outsides;
    w->slip_speed = contact->slip_speed;
    w->implicit = contact->coupling == COUPLING_IMPLICIT;
    w->self = self;
    w->distance = isnan(contact->self.distance) ? body->thickness : contact->self.distance;
    w->self_local = isnan(contact->self.distance) && body->outsides;
    w->rubs = contact->friction > 0;
    for (int k = 0; k < scene->obstacles_count; k++)
        w->rubs = w->rubs || scene->obstacles[k].friction > 0; /* NaN is not */
    w->wet = scene->water != NULL;
    if (w->wet) {
        w->outer = body->closed || scene->water->sides == SIDES_OUTER;
        w->flow = read_flow(b, &scene->water->velocity, &ok);
        ok = (body->closed || !w->outer || check_closed(b)) && ok;
    }
    return ok;
}

/* ---- Numbers ---- */

static double largest_young(const Model *model, const double *p)
{
    const ParamBlock *block = params_find(model->params, "young");
    double largest = 0;
    for (int i = 0; i < block->count; i++) largest = fmax(largest, p[block->offset + i]);
    return largest;
}

static double largest_mass(const Model *model, const double *p)
{
    double *mass = mem_alloc((size_t)model->point_count, sizeof *mass), largest = 0;
    model_masses(model, p, mass);
    for (int v = 0; v < model->point_count; v++) largest = fmax(largest, mass[v]);
    mem_free(mass);
    return largest;
}

/* How fast it may meet something, m/s: as the scene has it start, or after a fall of its own size. Where it goes on from
 * another run it is the one that was: as stiff a contact. */
static double likely_speed(const Model *model, const Case *c, double gravity, bool goes_on)
{
    const WorldBody *body = &model->world->body;
    double fastest = 0, low[3] = {0}, high[3] = {0}, size = 0;
    for (int v = 0; v < body->vertex_count; v++) {
        const double *x = body->rest[v];
        if (!goes_on) fastest = fmax(fastest, vec3_length(vec3_load(c->state.v + body->first + 3 * v)));
        for (int i = 0; i < 3; i++) {
            low[i] = v ? fmin(low[i], x[i]) : x[i];
            high[i] = v ? fmax(high[i], x[i]) : x[i];
        }
    }
    for (int i = 0; i < 3; i++) size += (high[i] - low[i]) * (high[i] - low[i]);
    return fmax(fastest, sqrt(2 * gravity * sqrt(size)));
}

/* On a vertex, N. */
static double largest_load(const Model *model, const double *p)
{
    const ParamBlock *block = params_find(model->params, "load");
    double largest = 0;
    for (int i = 0; block && i < block->count; i++)
        largest = fmax(largest, vec3_length(vec3_load(p + block->offset + 3 * i)));
    return largest;
}

static double shortest_edge(const WorldBody *body)
{
    double shortest = INFINITY;
    for (int e = 0; e < body->edge_count; e++) {
        const int *v = body->edges[e];
        Vec3 edge = vec3_sub(vec3_load(body->rest[v[1]]), vec3_load(body->rest[v[0]]));
        shortest = fmin(shortest, vec3_length(edge));
    }
    return shortest;
}

/* N/m: of what is pressed by its own elasticity. */
static double pressed(const WorldBody *body, double young)
{
    double size = world_body_measure(body);
    if (body->face_count) return PRESSED * young * size;
    return BENT * young * size * size / (SUNK * shortest_edge(body));
}

/* N/m at a sample. */
static double stiffness_of(const Model *model, const Scene *scene, const Case *c, const double *p)
{
    const WorldBody *body = &model->world->body;
    double sunk = SUNK * world_body_measure(body), least = sunk * world_thinnest(body),
           mass = largest_mass(model, p);
    double gravity = model->gravity < 0 ? 0 : vec3_length(vec3_load(p + model->gravity));
    double k = fmax(pressed(body, largest_young(model, p)), WEIGHTS * mass * gravity / sunk);
    k = fmax(k, largest_load(model, p) / least);
    if (!model->job->motion) return k;
    return fmax(k, mass * likely_speed(model, c, gravity, scene->start != NULL) / (scene->time.step * sunk));
}

static void put_numbers(const Model *model, const Scene *scene, const Case *c, double *p)
{
    const World *world = model->world;
    const ContactScene *contact = &scene->contact;
    if (world->obstacle_count)
        p[world->stiffness] =
            contact->stiffness.mode == 0 ? stiffness_of(model, scene, c, p) : contact->stiffness.value;
    for (int k = 0; k < world->obstacle_count; k++) {
        double own = scene->obstacles[k].friction;
        p[world->friction + k] = isnan(own) ? contact->friction : own;
    }
    if (world->self) {
        double given = contact->self.stiffness;
        p[world->self_stiffness] = isnan(given) ? largest_young(model, p) * pow(world->distance, 3) : given;
        p[world->self_friction] = contact->friction;
    }
    if (!world->wet) return;
    p[world->water.density] = scene->water->density;
    p[world->water.viscosity] = scene->water->viscosity;
    if (!scene->water->velocity.formula)
        memcpy(p + world->water.velocity, scene->water->velocity.value, 3 * sizeof *p);
}

void model_put_world(Model *model, const Scene *scene)
{
    for (int k = 0; model->world && k < model->case_count; k++)
        for (int s = 0; s < model->cases[k].stage_count; s++)
            put_numbers(model, scene, &model->cases[k], model->cases[k].stages[s].p);
}

/* ---- Where it starts ---- */

/* Faces that an edge belongs to, by their numbers in the mesh's file where it has faces: a name for people. */
static int face_of_edge(const WorldBody *body, int edge)
{
    const int *e = body->edges[edge];
    for (int f = 0; f < body->face_count; f++) {
        int found = 0;
        for (int i = 0; i < 3; i++) found += body->faces[f][i] == e[0] || body->faces[f][i] == e[1];
        if (found == 2) return f;
    }
    return edge;
}

/* At no distance contact has no energy, and no direction to push in. */
static bool check_touch(const World *world, const Case *c, YamlFile *file)
{
    const double touching = 1e-12; /* of the distance */
    int vertices[2];
    if (isinf(world_nearest(world, c->state.x, touching, vertices))) return true;
    return yaml_refuse(
        file, "contact.self",
        "where %s starts, parts of the body touch each other, with no distance between them: at %s %d "
        "and %d. Self contact needs a start without",
        c->name, world->body.face_count ? "vertices" : "nodes", vertices[0], vertices[1]);
}

/* Contact of a single piece leaves out what is near at rest. */
static bool check_size(const World *world, YamlFile *file)
{
    double size = world_meets_nothing(world);
    if (isinf(size)) return true;
    return yaml_refuse(file, "contact.self.distance",
                       "parts nearer to each other than 1.6 distances at rest, %.3g m, do not meet, and the "
                       "whole body is %.3g m long: nothing would. The thickness, %.3g m, is a distance that "
                       "fits most bodies",
                       SELF_CONTACT_REST * world->distance, size, world->body.thickness);
}

/* At the times of a case's stages; those of a motion come along with it (model_load). */
static bool check_poses(const World *world, const Case *c, YamlFile *file)
{
    Error err;
    for (int s = 0; s < c->stage_count; s++)
        if (!world_stands(world, c->stages[s].time, &err))
            return yaml_refuse(file, "obstacles", "%s", err.text);
    return true;
}

bool model_check_world(Model *model, YamlFile *file)
{
    const World *world = model->world;
    for (int k = 0; world && k < model->case_count; k++)
        if (!check_poses(world, &model->cases[k], file)) return false;
    if (world && world->self && !check_size(world, file)) return false;
    for (int k = 0; world && world->self && k < model->case_count; k++) {
        const Case *c = &model->cases[k];
        int pair[1][2], count = world_crossings(world, c->state.x, pair, 1);
        if (count == 0) {
            if (!check_touch(world, c, file)) return false;
            continue;
        }
        bool faces = world->body.face_count > 0;
        return yaml_refuse(
            file, "contact.self",
            "where it starts, the body passes through itself in %d place%s: first %s %d and %d. Self "
            "contact needs a start without",
            count, count == 1 ? "" : "s", faces ? "faces" : "elements",
            faces ? face_of_edge(&world->body, pair[0][0]) : pair[0][0], pair[0][1]);
    }
    return true;
}
