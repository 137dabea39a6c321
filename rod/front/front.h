/* front.h - what the files of this front have of each other: parts of the rod's row (body.c). Model.self is a RodModel. */
#pragma once
#include "rod/front/rod_model.h"
#include "rod/front/scene.h"

/* records.c: rods in the journal. */
void rod_add_static(const Model *model, Arrays *list);

/* Of each element of strands, where they vary or a section is given. */
void rod_add_sections(const RodModel *rm, int strands, int each, Arrays *list);
void rod_body_places(const Model *model, const double *x, double *place);
void rod_add_frame(const Model *model, const Snapshot *shot, bool whole, Arrays *list);
void rod_add_stress(const Model *model, const Snapshot *shot, Arrays *list);
void rod_add_state(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list);
void rod_add_final(const Model *model, const Snapshot *shot, int modes, Arrays *list);
char *rod_doubt(const Model *model, const Snapshot *shot);
char *rod_crushed(const Model *model, const Snapshot *shot, bool failed);

/* motion.c: the curves of a moving rod become strands, with their inertia and drag as loads. */
bool rod_read_motion(RodModel *rm, const RodScene *scene, const Build *b);

/* Natural strains of several curves of one rod, strain[count][nodes][3]: their mean, and how far they are from it, rms. Returns
 * that of all of them, 1/m. */
double rod_add_mean_strains(const double *strain, int count, int nodes, Arrays *list);

/* job_invert.c: does the scene say what an inversion needs, and nothing that it does not use? */
bool rod_check_inversion(const RodModel *rm, const Scene *scene, YamlFile *file);

/* supports.c: how the scene holds its ends, into the model. */
bool rod_read_supports(RodModel *rm, const RodScene *scene, const Build *b);

/* ends.c: */

/* Is a place where it is wanted, to 1e-6 of a size? A node, with that frame to 1e-6 rad (NULL: any)? The other end, if it is
 * held? */
bool rod_is_near(Vec3 place, Vec3 wanted, double size);
bool rod_is_at(const RodLayout *layout, const double *x, int node, Vec3 place, const Quat *frame,
               double size);
bool rod_end_is_held(const RodModel *rm, double time, const double *x);

/* Keeps where the first ends are before they move; unless the job leads them, the strands of the rod and the state x, of turns
 * only, stand where it begins. */
bool rod_stand_first(const Model *model, double *x, Error *err);

/* Can the rod follow its ends? Sees to enough load steps. */
bool rod_check_ends(Model *model, const Scene *scene, const Build *b);

/* A node, a part of the way from where x has it to a place and a frame (NULL: it turns freely). */
void rod_lead_end(const RodLayout *layout, int node, Vec3 place, const Quat *frame, double part, double *x);

/* Does the job itself bring the rod to its supports? If not, before it begins the rod is brought there without loads, model->x.
 * And BodyOps.move. */
bool rod_leads_ends(const Model *model);
bool rod_settle(Model *model, const Build *b, const double *p);
bool rod_move_ends(const Model *model, HeldWay way, double *x, Error *err);

/* Do ends move by formulas? */
bool rod_ends_move(const RodModel *rm);

/* The first ends, then the last one if it is held: rows of 3x4 matrices whose columns are tangent, n1, n2 (NAN where it turns
 * freely) and place, poses[rod_support_count][12]: as they stand where the job begins to lead them, and in a state. */
int rod_support_count(const RodModel *rm);
void rod_support_poses(const RodModel *rm, double *poses);
void rod_support_poses_in(const RodModel *rm, const double *x, double *poses);

/* take_state.c: BodyOps.take_state. */
bool rod_take_state(const Model *model, const double *from, int dofs, double *x, Error *err);

/* BodyOps.supports and couples; and the nodes that are held, into the model. */
void rod_support_forces(const Model *model, const Snapshot *shot, double *force);
void rod_support_couples(const Model *model, const Snapshot *shot, double *couple);
void rod_add_supports(Model *model);

/* report.c, cost.c */
char *rod_doubt_magnets(const Model *model, const Snapshot *shot);
char *rod_describe(const Model *model, const Scene *scene);
void rod_advise(Model *model, const Scene *scene);
void rod_dof_sizes(const Model *model, double *size);
void rod_cost(const Model *model, Cost *cost);

/* The rod's own jobs, each in its file. */
extern const JobRow rod_job_simulate, rod_job_invert, rod_job_identify;
