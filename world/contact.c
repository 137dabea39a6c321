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

bool contact_update(void *self, const Point *at)
{
    return poses_update(&((Contact *)self)->poses, at);
}

/* At a place, summed over the obstacles: energy, its gradient, and where H is not NULL its Hessian. */
static double press(const Contact *c, double stiffness, const double place[3], double g[3], double H[3][3])
{
    double energy = 0;
    for (int i = 0; i < 3; i++) g[i] = 0;
    for (int i = 0; H && i < 9; i++) H[i / 3][i % 3] = 0;
    for (int k = 0; k < c->def.obstacle_count; k++) {
        Gap gap;
        const Obstacle *obstacle = &c->def.obstacles[k];
        if (obstacle_is_beyond(obstacle, &c->poses.end[k], place, c->def.offset)) continue;
        obstacle_gap(obstacle, &c->poses.end[k], place, &gap);
        double depth = c->def.offset - gap.value;
        if (depth <= 0) continue; /* NaN is none of these */
        Penalty penalty = penalty_at(depth, c->def.smoothing, stiffness);
        energy += penalty.energy;
        for (int i = 0; i < 3; i++) {
            g[i] -= penalty.force * gap.gradient[i];
            for (int j = 0; H && j < 3; j++)
                H[i][j] +=
                    penalty.slope * gap.gradient[i] * gap.gradient[j] - penalty.force * gap.hessian[i][j];
        }
    }
    return energy;
}

static Pack contact_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    (void)pack;
    const Contact *c = self;
    Pack3 place = samples_mean(&c->def.samples, x), force;
    Pack energy;
    PackMat A;
    double k = at->p[c->def.stiffness];
    for (int l = 0; l < PACK_LANES; l++) {
        double slope[3], stiffness[3][3];
        energy[l] = press(c, k, (double[]){place.x[l], place.y[l], place.z[l]}, slope, H ? stiffness : NULL);
        lane_put(&force, l, slope);
        if (H) lane_put_matrix(&A, l, stiffness);
    }
    if (g) samples_spread(&c->def.samples, force, g);
    if (H) samples_spread_matrix(&c->def.samples, A, H);
    return energy;
}

/* dE/dx over the stiffness, in which it is linear. */
static Pack3 slope_of_stiffness(const Contact *c, const Pack *x)
{
    Pack3 place = samples_mean(&c->def.samples, x), r;
    for (int l = 0; l < PACK_LANES; l++) {
        double slope[3];
        press(c, 1, (double[]){place.x[l], place.y[l], place.z[l]}, slope, NULL);
        lane_put(&r, l, slope);
    }
    return r;
}

static void contact_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                          const Pack *w, double *dp)
{
    (void)pack, (void)at;
    const Contact *c = self;
    Pack3 slope = slope_of_stiffness(c, x);
    dp[c->def.stiffness] += pack_sum(pack3_dot(slope, samples_mean(&c->def.samples, w)), lanes);
}

static void contact_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                  const double *dp, Pack *r)
{
    (void)pack, (void)at;
    const Contact *c = self;
    Pack3 slope = slope_of_stiffness(c, x);
    samples_spread(&c->def.samples, pack3_scale(pack_set(dp[c->def.stiffness]), slope), r);
}

void contact_destroy(void *self)
{
    Contact *c = self;
    poses_destroy(&c->poses);
    mem_free(c->def.samples.vertices);
    mem_free(c->def.faces.vertices);
    mem_free(c->held);
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
    for (int e = 0; e < samples->count; e++) c->held[e] = is_held(def, e);
    return c;
}

/* Its elements last; `update` is for obstacles that move only. */
#define CONTACT_OPS                                                                                          \
    .name = "contact", .idles = true, .count = contact_count, .size = contact_size, .dofs = contact_dofs,    \
    .reach = contact_reach, .project = contact_project, .passes = contact_passes, .eval = contact_eval,      \
    .param = contact_param, .param_forward = contact_param_forward, .destroy = contact_destroy

static const TermOps still_ops = {CONTACT_OPS}, moving_ops = {CONTACT_OPS, .update = contact_update};

Term contact_term(const ContactDef *def)
{
    Contact *c = contact_create(def);
    return (Term){c->poses.moves ? &moving_ops : &still_ops, c};
}
