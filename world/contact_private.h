/* contact_private.h - what contact.c and friction.c share. */
#pragma once
#include "world/contact.h"
#include "world/poses.h"

typedef struct Contact {
    ContactDef def; /* its samples are its own */
    Poses poses;
    bool *held;                 /* [sample] all of its corners are           */
    double *offset, *smoothing; /* [sample] m, where it stands               */
    bool stands;                /* it does                                   */
    int dofs;                   /* up to the last position                   */
    double *trial;              /* [dofs] of a way                           */
} Contact;

Contact *contact_create(const ContactDef *def);
void contact_destroy(void *self);
int contact_count(const void *self);
int contact_size(const void *self);
void contact_dofs(const void *self, int e, int *dof);
bool contact_update(void *self, const Point *at);
bool contact_changes(const Contact *c);
double contact_reach(const void *self, const Point *at, const double *d);
void contact_project(const void *self, const double *from, double *x);
bool contact_passes(const void *self, const Point *at);

typedef struct Penalty {
    double energy, force, slope; /* of a depth: J, N, N/m               */
    double soften;               /* dN/de, N/m: of the smoothing length */
} Penalty;

/* Of a positive depth d, with smoothing e and stiffness k (contact.h). */
static inline Penalty penalty_at(double d, double e, double k)
{
    if (d < e)
        return (Penalty){k * d * d * d / (6 * e), k * d * d / (2 * e), k * d / e, -k * d * d / (2 * e * e)};
    return (Penalty){k * (d * d / 2 - e * d / 2 + e * e / 6), k * (d - e / 2), k, -k / 2};
}

/* dN/d offset, N/m: the depth grows with it, and the smoothing length in proportion. */
static inline double penalty_of_offset(const ContactDef *def, const Penalty *penalty)
{
    return penalty->slope + penalty->soften * def->smoothing / def->offset;
}

/* The sample in a lane; the last pack is filled up. */
static inline int contact_sample(const Contact *c, int pack, int lane)
{
    int e = pack * PACK_LANES + lane, last = c->def.samples.count - 1;
    return e < last ? e : last;
}

static inline bool contact_is_beyond(const Contact *c, int k, const RigidPose *pose, int e,
                                     const double place[3])
{
    return obstacle_is_beyond(&c->def.obstacles[k], pose, place, c->offset[e]);
}

static inline void lane_put(Pack3 *to, int lane, const double from[3])
{
    to->x[lane] = from[0], to->y[lane] = from[1], to->z[lane] = from[2];
}

static inline void lane_put_matrix(PackMat *to, int lane, double from[3][3])
{
    lane_put(&to->r0, lane, from[0]);
    lane_put(&to->r1, lane, from[1]);
    lane_put(&to->r2, lane, from[2]);
}

static inline void lane_get(Pack3 from, int lane, double to[3])
{
    to[0] = from.x[lane], to[1] = from.y[lane], to[2] = from.z[lane];
}
