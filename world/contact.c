#include "world/contact.h"
#include "base/memory.h"
#include "world/contact_private.h"

int contact_count(const void *self)
{
    return ((const Contact *)self)->def.samples.count;
}

int contact_size(const void *self)
{
    return 3 * ((const Contact *)self)->def.samples.corners;
}

void contact_dofs(const void *self, int e, int *dof)
{
    samples_dofs(&((const Contact *)self)->def.samples, e, dof);
}

/* Its elements last; what it stands by does not: where obstacles are, and how thick the body is. */
bool contact_changes(const Contact *c)
{
    return c->poses.moves || c->def.outside;
}

bool contact_update(void *self, const Point *at)
{
    Contact *c = self;
    bool first = !c->stands;
    c->stands = true;
    poses_update(&c->poses, at);
    for (int e = 0; c->def.outside && e < c->def.samples.count; e++) {
        c->offset[e] = outside_at(c->def.outside, e, at->p);
        c->smoothing[e] = c->offset[e] * c->def.smoothing / c->def.offset;
    }
    return first;
}

/* Of sample e at a place, summed over the obstacles: energy, its gradient, and where H is not NULL its Hessian. Where swell is
 * not NULL the gradient's derivative to the offset. */
static double press(const Contact *c, int e, double stiffness, const double place[3], double g[3],
                    double H[3][3], double *swell)
{
    double energy = 0;
    for (int i = 0; swell && i < 3; i++) swell[i] = 0;
    for (int i = 0; i < 3; i++) g[i] = 0;
    for (int i = 0; H && i < 9; i++) H[i / 3][i % 3] = 0;
    for (int k = 0; k < c->def.obstacle_count; k++) {
        Gap gap;
        if (contact_is_beyond(c, k, &c->poses.end[k], e, place)) continue;
        obstacle_gap(&c->def.obstacles[k], &c->poses.end[k], place, &gap);
        double depth = c->offset[e] - gap.value;
        if (depth <= 0) continue; /* NaN is none of these */
        Penalty penalty = penalty_at(depth, c->smoothing[e], stiffness);
        energy += penalty.energy;
        for (int i = 0; i < 3; i++) {
            g[i] -= penalty.force * gap.gradient[i];
            if (swell) swell[i] -= penalty_of_offset(&c->def, &penalty) * gap.gradient[i];
            for (int j = 0; H && j < 3; j++)
                H[i][j] +=
                    penalty.slope * gap.gradient[i] * gap.gradient[j] - penalty.force * gap.hessian[i][j];
        }
    }
    return energy;
}

static Pack contact_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const Contact *c = self;
    Pack3 place = samples_mean(&c->def.samples, x), force;
    Pack energy;
    PackMat A;
    double k = at->p[c->def.stiffness];
    for (int l = 0; l < PACK_LANES; l++) {
        double slope[3], stiffness[3][3];
        energy[l] = press(c, contact_sample(c, pack, l), k, (double[]){place.x[l], place.y[l], place.z[l]},
                          slope, H ? stiffness : NULL, NULL);
        lane_put(&force, l, slope);
        if (H) lane_put_matrix(&A, l, stiffness);
    }
    if (g) samples_spread(&c->def.samples, force, g);
    if (H) samples_spread_matrix(&c->def.samples, A, H);
    return energy;
}

/* dE/dx of a lane over the stiffness, in which it is linear, and that one's derivative to the sample's offset. */
static void slope_of_lane(const Contact *c, int pack, int lane, Pack3 place, double slope[3], double swell[3])
{
    double at[3];
    lane_get(place, lane, at);
    press(c, contact_sample(c, pack, lane), 1, at, slope, NULL, c->def.outside ? swell : NULL);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void contact_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                          const Pack *w, double *dp)
{
    const Contact *c = self;
    Pack3 place = samples_mean(&c->def.samples, x), b = samples_mean(&c->def.samples, w);
    Pack along;
    for (int l = 0; l < PACK_LANES; l++) {
        double slope[3], swell[3], own[3];
        slope_of_lane(c, pack, l, place, slope, swell);
        lane_get(b, l, own);
        along[l] = dot(slope, own);
        if (c->def.outside && l < lanes)
            outside_back(c->def.outside, contact_sample(c, pack, l),
                         at->p[c->def.stiffness] * dot(swell, own), dp);
    }
    dp[c->def.stiffness] += pack_sum(along, lanes);
}

static void contact_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                  const double *dp, Pack *r)
{
    const Contact *c = self;
    Pack3 place = samples_mean(&c->def.samples, x), force;
    for (int l = 0; l < PACK_LANES; l++) {
        double slope[3], swell[3] = {0}, grown = 0;
        slope_of_lane(c, pack, l, place, slope, swell);
        if (c->def.outside)
            grown = at->p[c->def.stiffness] * outside_change(c->def.outside, contact_sample(c, pack, l), dp);
        for (int i = 0; i < 3; i++) slope[i] = dp[c->def.stiffness] * slope[i] + grown * swell[i];
        lane_put(&force, l, slope);
    }
    samples_spread(&c->def.samples, force, r);
}

void contact_destroy(void *self)
{
    Contact *c = self;
    poses_destroy(&c->poses);
    mem_free(c->def.samples.vertices);
    mem_free(c->def.faces.vertices);
    mem_free(c->held);
    mem_free(c->offset);
    mem_free(c->smoothing);
    mem_free(c->trial);
    mem_free(c);
}

static bool is_held(const ContactDef *def, int e)
{
    bool held = def->fixed != NULL;
    for (int i = 0; held && i < 3 * def->samples.corners; i++)
        held = def->fixed[3 * def->samples.vertices[e * def->samples.corners + i / 3] + i % 3];
    return held;
}

static int *samples_copy(const Samples *samples)
{
    return mem_copy(samples->vertices, (size_t)samples->count * (size_t)samples->corners,
                    sizeof *samples->vertices);
}

Contact *contact_create(const ContactDef *def)
{
    Contact *c = mem_alloc(1, sizeof *c);
    *c = (Contact){.def = *def, .poses = poses_create(def->obstacles, def->obstacle_count)};
    const Samples *samples = &def->samples;
    c->def.samples.vertices = samples_copy(samples);
    c->def.faces.vertices = samples_copy(&def->faces);
    c->dofs = samples->first + 3 * def->vertex_count;
    c->trial = mem_alloc((size_t)c->dofs, sizeof *c->trial);
    c->held = mem_alloc((size_t)samples->count, sizeof *c->held);
    c->offset = mem_alloc((size_t)samples->count, sizeof *c->offset);
    c->smoothing = mem_alloc((size_t)samples->count, sizeof *c->smoothing);
    for (int e = 0; e < samples->count; e++) {
        c->held[e] = is_held(def, e);
        c->offset[e] = def->offset, c->smoothing[e] = def->smoothing;
    }
    return c;
}

/* Its elements last: one that does not change (contact_changes) needs no `update`. */
#define CONTACT_OPS                                                                                          \
    .name = "contact", .idles = true, .count = contact_count, .size = contact_size, .dofs = contact_dofs,    \
    .reach = contact_reach, .project = contact_project, .passes = contact_passes, .eval = contact_eval,      \
    .param = contact_param, .param_forward = contact_param_forward, .destroy = contact_destroy

static const TermOps still_ops = {CONTACT_OPS}, changing_ops = {CONTACT_OPS, .update = contact_update};

Term contact_term(const ContactDef *def)
{
    Contact *c = contact_create(def);
    return (Term){contact_changes(c) ? &changing_ops : &still_ops, c};
}
