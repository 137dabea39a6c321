/* forces.h - what holds a body, and what obstacles do to it. */
#pragma once
#include "io/arrays.h"
#include "model/model.h"

/* What holds so many points, along these axes: an entry of the scene's `fix`; of a rod its clamp, then its end. Takes
 * the points. */
void model_add_support(Model *model, Indices points, const bool axis[3]);

/* What each does to the body, force[support_count][3] N: at the end of a step of time also what accelerates and damps what it
 * holds, else as at rest. What two of them hold counts for the first, so that the sum is that of all. */
void model_support_forces(const Model *model, const Snapshot *shot, double (*force)[3]);

/* The couples of each, of a body whose frames are held, too (BodyOps.couples), couple[support_count][3] N m: the sum of those on
 * its points, each about its own. */
void model_support_couples(const Model *model, const Snapshot *shot, double (*couple)[3]);

/* Both, as PREFIX/support_force and support_couple, into the list. */
void model_add_supports(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list);

/* The part of what the supports do that acts on these points: on all that is held of them. */
void model_force_on(const Model *model, const Snapshot *shot, const Indices *points, double force[3]);

/* What obstacles do to the body: of a step of time at its end, else as in statics. The vectors are the snapshot's or the
 * list's. For a body with a world. */
ContactSums model_contacts(const Model *model, const Snapshot *shot, Arrays *list);

/* Where a snapshot stands: at the end of a step of time, or in statics. */
Point model_point(const Snapshot *shot);

/* BodyOps.supports of a body whose positions are dofs, from `first` on: forces that are not in balance where it is held. */
void model_held_forces(const Model *model, const Snapshot *shot, int first, double *force);
