#include "world/world.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "world/crossings.h"
#include "world/self_pairs.h"
#include "world/poses.h"
#include <math.h>

/* Parts of a shell's thickness or a rod's radius: the depth at which the penalty is linear, half of which is sunk. */
static const double SMOOTHING = 0.01;

double world_body_measure(const WorldBody *body)
{
    return body->face_count ? body->thickness : body->thickness / 2;
}

double world_thinnest(const WorldBody *body)
{
    double least = body->outside;
    int cells = body->face_count ? body->face_count : body->edge_count;
    for (int f = 0; body->outsides && f < cells; f++) least = fmin(least, body->outsides[f]);
    return body->outsides ? least / body->outside : 1;
}

/* From other dofs: those of rods do. */
static bool positions_follow(const WorldBody *body)
{
    return body->face_count == 0;
}

/* The vertices of each edge or face, [count][corners], of which one edge at least is longer than that; all where it is 0. */
static Samples long_ones(const WorldBody *body, const int *corners_of, int count, int corners, double longer)
{
    Samples samples = {.corners = corners, .first = body->first};
    samples.vertices = mem_alloc((size_t)count * (size_t)corners, sizeof *samples.vertices);
    for (int e = 0; e < count; e++) {
        const int *v = corners_of + e * corners;
        double longest = 0;
        for (int i = 0; i < corners; i++) {
            Vec3 a = vec3_load(body->rest[v[i]]), b = vec3_load(body->rest[v[(i + 1) % corners]]);
            longest = fmax(longest, vec3_length(vec3_sub(a, b)));
        }
        if (longest <= longer) continue;
        for (int i = 0; i < corners; i++) samples.vertices[samples.count * corners + i] = v[i];
        samples.count++;
    }
    return samples;
}

/* But for those within a solid, which are in no face. */
static Samples all_vertices(const WorldBody *body)
{
    Samples samples = {0, 1, mem_alloc((size_t)body->vertex_count, sizeof(int)), body->first};
    bool *inside = mem_alloc((size_t)body->vertex_count, sizeof *inside);
    for (int v = 0; v < body->vertex_count; v++) inside[v] = body->face_count > 0;
    for (int i = 0; i < 3 * body->face_count; i++) inside[body->faces[i / 3][i % 3]] = false;
    for (int v = 0; v < body->vertex_count; v++)
        if (!inside[v]) samples.vertices[samples.count++] = v;
    mem_free(inside);
    return samples;
}

/* What nothing is to go through: its faces, or elements; borrowed. */
static Samples faces_of(const WorldBody *body)
{
    bool rod = body->face_count == 0;
    const int *corners = rod ? (const int *)body->edges : (const int *)body->faces;
    return (Samples){rod ? body->edge_count : body->face_count, rod ? 2 : 3, (int *)corners, body->first};
}

/* NULL: the same everywhere. */
static Outside *outside_of(const WorldBody *body, const Samples *parts)
{
    Samples cells = faces_of(body);
    if (!body->outsides) return NULL;
    return outside_create(parts, &cells, body->rest, body->vertex_count, body->outsides, body->doubled);
}

/* Takes the samples; the first of them ask for all faces, too. */
static void add_contact(World *world, Samples samples)
{
    if (samples.count == 0) {
        mem_free(samples.vertices);
        return;
    }
    Samples faces = world->contact_kinds == 0 ? faces_of(&world->body) : (Samples){0};
    world->outside[world->contact_kinds] = outside_of(&world->body, &samples);
    world->contacts[world->contact_kinds++] =
        (ContactDef){.obstacles = world->obstacles,
                     .obstacle_count = world->obstacle_count,
                     .samples = samples,
                     .faces = faces,
                     .vertex_count = world->body.vertex_count,
                     .fixed = world->body.fixed,
                     .derived = positions_follow(&world->body),
                     .smoothing = SMOOTHING * world_body_measure(&world->body)};
}

static double *outsides_of(const WorldBody *body, Samples parts)
{
    Outside *outside = outside_of(body, &parts);
    double *m = mem_alloc((size_t)parts.count, sizeof *m);
    for (int e = 0; e < parts.count; e++) m[e] = outside_at(outside, e, NULL);
    outside_destroy(outside);
    return m;
}

/* Of vertices and edges, by which parts of the body meet each other. */
static void find_outsides(World *world)
{
    const WorldBody *body = &world->body;
    if (!body->outsides) return;
    int *all = mem_alloc((size_t)body->vertex_count, sizeof *all);
    for (int v = 0; v < body->vertex_count; v++) all[v] = v;
    world->vertex_outside = outsides_of(body, (Samples){body->vertex_count, 1, all, body->first});
    world->edge_outside = outsides_of(body, (Samples){body->edge_count, 2, (int *)body->edges, body->first});
    mem_free(all);
}

World *world_create(const WorldBody *body, Obstacle *obstacles, int obstacle_count)
{
    World *world = mem_alloc(1, sizeof *world);
    *world = (World){.body = *body, .obstacles = obstacles, .obstacle_count = obstacle_count};
    find_outsides(world);
    double feature = INFINITY;
    for (int k = 0; k < obstacle_count; k++) feature = fmin(feature, obstacles[k].feature);
    if (obstacle_count == 0) return world;
    add_contact(world, all_vertices(body));
    add_contact(world, long_ones(body, (const int *)body->edges, body->edge_count, 2, feature));
    if (body->face_count)
        add_contact(world, long_ones(body, (const int *)body->faces, body->face_count, 3, feature));
    return world;
}

void world_destroy(World *world)
{
    if (!world) return;
    for (int k = 0; k < world->obstacle_count; k++) obstacle_clear(&world->obstacles[k]);
    for (int k = 0; k < world->contact_kinds; k++) {
        mem_free(world->contacts[k].samples.vertices);
        outside_destroy(world->outside[k]);
    }
    mem_free(world->vertex_outside);
    mem_free(world->edge_outside);
    mem_free(world->obstacles);
    flux_field_destroy(world->flow);
    mem_free(world);
}

void world_add_params(World *world, Params *params)
{
    if (world->obstacle_count) {
        world->stiffness = params_add(params, "contact_stiffness", "N/m", 1, 1, false);
        world->friction = params_add(params, "friction", "", world->obstacle_count, 1, false);
    }
    if (world->self) {
        world->self_stiffness = params_add(params, "self_stiffness", "J", 1, 1, false);
        world->self_friction = params_add(params, "self_friction", "", 1, 1, false);
    }
    if (!world->wet) return;
    world->water = (Water){.density = params_add(params, "water_density", "kg/m^3", 1, 1, false),
                           .viscosity = params_add(params, "water_viscosity", "Pa s", 1, 1, false),
                           .velocity = params_add(params, "water_velocity", "m/s", 1, 3, false),
                           .flow = world->flow};
}

/* As it is now: offset and slip speed are known. */
static ContactDef contact_of(const World *world, int kind)
{
    ContactDef def = world->contacts[kind];
    def.offset = world->offset;
    def.outside = world->local ? world->outside[kind] : NULL;
    def.slip_speed = world->slip_speed;
    def.stiffness = world->stiffness;
    def.friction = world->friction;
    return def;
}

static SelfContactDef self_of(const World *world)
{
    const WorldBody *body = &world->body;
    return (SelfContactDef){.vertex_count = body->vertex_count,
                            .first = body->first,
                            .face_count = body->face_count,
                            .edge_count = body->edge_count,
                            .faces = body->faces,
                            .edges = body->edges,
                            .rest = body->rest,
                            .part = body->part,
                            .fixed = body->fixed,
                            .derived = positions_follow(body),
                            .distance = world->distance,
                            .vertex_outside = world->self_local ? world->vertex_outside : NULL,
                            .edge_outside = world->self_local ? world->edge_outside : NULL,
                            .face_outside = world->self_local ? body->outsides : NULL,
                            .stiffness = world->self_stiffness,
                            .friction = world->self_friction,
                            .slip_speed = world->slip_speed};
}

int world_crossings(const World *world, const double *x, int (*pairs)[2], int max)
{
    SelfContactDef def = self_of(world);
    return self_contact_crossings(&def, x, pairs, max);
}

double world_nearest(const World *world, const double *x, double parts, int vertices[2])
{
    SelfContactDef def = self_of(world);
    return self_contact_nearest(&def, x, parts, vertices);
}

double world_meets_nothing(const World *world)
{
    SelfContactDef def = self_of(world);
    return self_contact_nothing(&def);
}

static Term water_of(const World *world)
{
    const WorldBody *body = &world->body;
    if (body->face_count)
        return water_term(
            &(WaterDef){body->face_count, body->first, (int(*)[3])body->faces, world->outer, world->water});
    return rod_water_term(&(RodWaterDef){.element_count = body->edge_count,
                                         .strands = body->strands,
                                         .first = body->first,
                                         .length = body->length,
                                         .radius = body->radius,
                                         .water = world->water});
}

void world_add_terms(const World *world, System *sys, bool motion)
{
    for (int k = 0; k < world->contact_kinds; k++) {
        ContactDef def = contact_of(world, k);
        system_add(sys, contact_term(&def));
        if (motion && world->rubs) system_add(sys, friction_term(&def));
    }
    if (world->self) {
        SelfContactDef def = self_of(world);
        system_add(sys, self_contact_term(&def));
        if (motion && world->rubs) system_add(sys, self_friction_term(&def));
    }
    if (motion && world->wet) system_add(sys, water_of(world));
}

bool world_stands(const World *world, double time, Error *err)
{
    RigidPose pose;
    for (int k = 0; k < world->obstacle_count; k++)
        if (!obstacle_pose(&world->obstacles[k], time, &pose, err)) return false;
    return true;
}

int world_vertex(const World *world, int e)
{
    return world->contacts[0].samples.vertices[e];
}

double world_offset(const World *world, int e, const double *p)
{
    return world->local && world->outside[0] ? outside_at(world->outside[0], e, p) : world->offset;
}

void world_lean(const World *world, double time, const double *p, double depth, double *x)
{
    Poses poses = poses_create(world->obstacles, world->obstacle_count);
    double *place = x + world->body.first, way = INFINITY, normal[3] = {0};
    poses_update(&poses, &(Point){.time = time});
    for (int k = 0; k < world->obstacle_count; k++)
        for (int e = 0; e < world->contacts[0].samples.count; e++) {
            Gap gap;
            obstacle_gap(&world->obstacles[k], &poses.end[k], place + 3 * world_vertex(world, e), &gap);
            double free = gap.value - world_offset(world, e, p);
            if (!(free + depth < way)) continue;
            way = free + depth;
            vec3_store(normal, vec3_unit(vec3_load(gap.gradient)));
        }
    poses_destroy(&poses);
    for (int i = 0; i < 3 * world->body.vertex_count && way > 0 && isfinite(way); i++)
        place[i] -= way * normal[i % 3];
}

/* What the body does against a term in a step of time, J: the forces of its end times how far it went. */
static double work_against(const Term *term, const Point *at)
{
    int count = term->ops->count(term->self), size = term->ops->size(term->self);
    double sum = 0;
    for (int e = 0; e < count; e += PACK_LANES) {
        Pack x[TERM_MAX_DOF], moved[TERM_MAX_DOF], g[TERM_MAX_DOF];
        for (int l = 0; l < PACK_LANES; l++) {
            int dof[TERM_MAX_DOF];
            term->ops->dofs(term->self, e + l < count ? e + l : count - 1, dof);
            for (int i = 0; i < size; i++)
                x[i][l] = at->x[dof[i]], moved[i][l] = at->x[dof[i]] - at->x_prev[dof[i]];
        }
        term->ops->eval(term->self, e / PACK_LANES, at, x, g, NULL);
        for (int i = 0; i < size; i++)
            sum += pack_sum(g[i] * moved[i], e + PACK_LANES < count ? PACK_LANES : count - e);
    }
    return sum;
}

struct WorldGauge {
    const World *world;
    Term self; /* where it meets itself */
};

WorldGauge *world_gauge_create(const World *world)
{
    WorldGauge *gauge = mem_alloc(1, sizeof *gauge);
    SelfContactDef def = self_of(world);
    gauge->world = world;
    if (world->self) gauge->self = self_contact_term(&def);
    return gauge;
}

void world_gauge_destroy(WorldGauge *gauge)
{
    if (!gauge) return;
    if (gauge->world->self) gauge->self.ops->destroy(gauge->self.self);
    mem_free(gauge);
}

static void measure_self(const WorldGauge *gauge, const Point *at, WorldSums *sums)
{
    const World *world = gauge->world;
    SelfContactDef def = self_of(world);
    sums->self = self_contact_figures(&gauge->self, at->x, at->p[world->self_stiffness]);
    sums->pairs = sums->self.pairs;
    sums->crossings = crossings_find(self_pairs_neighbours(&gauge->self), at->x, NULL, 0);
    if (!world->rubs || !(at->dt > 0)) return;
    Term friction = self_friction_term(&def);
    Point own = *at; /* its list is made where its forces are taken */
    own.memory = point_lag(at) + world->body.first;
    friction.ops->update(friction.self, &own);
    sums->contact.friction += work_against(&friction, &own);
    friction.ops->destroy(friction.self);
}

/* Beside what earlier parts of the step were gone through. */
static void measure_pierced(const World *world, const Point *at, Pierced *sum)
{
    Samples faces = faces_of(&world->body);
    Poses poses = poses_create(world->obstacles, world->obstacle_count);
    poses_update(&poses, at);
    Pierced found = pierce_find(&poses, &faces, at->x_prev, at->x);
    poses_destroy(&poses);
    found.count += sum->count;
    if (sum->count) found.obstacle = sum->obstacle, found.face = sum->face;
    *sum = found;
}

void world_gauge_measure(const WorldGauge *gauge, const Point *at, WorldSums *sums)
{
    const World *world = gauge->world;
    for (int k = 0; k < world->contact_kinds; k++) {
        ContactDef def = contact_of(world, k);
        contact_measure(&def, at, &sums->contact);
    }
    if (at->dt > 0) measure_pierced(world, at, &sums->pierced);
    if (world->self) measure_self(gauge, at, sums);
    if (world->wet && at->dt > 0) {
        Term water = water_of(world);
        sums->water += work_against(&water, at);
        water.ops->destroy(water.self);
    }
}

void world_measure(const World *world, const Point *at, WorldSums *sums)
{
    WorldGauge *gauge = world_gauge_create(world);
    world_gauge_measure(gauge, at, sums);
    world_gauge_destroy(gauge);
}

double world_longest_edge(const World *world, const double *x)
{
    const WorldBody *body = &world->body;
    double longest = 0;
    for (int e = 0; e < body->edge_count; e++) {
        const int *v = body->edges[e];
        longest = fmax(longest, vec3_length(vec3_sub(vec3_load(x + 3 * v[0]), vec3_load(x + 3 * v[1]))));
    }
    return longest;
}

bool world_slips_between(const World *world, int obstacle, double longest)
{
    double least = world->local ? world->offset * world_thinnest(&world->body) : world->offset;
    return world->obstacles[obstacle].feature + least < longest / 4;
}
