/* rod_model.h - what a scene says of a rod, read and resolved: its curve (or many: strands), section, loads
 * and frames, and the discrete rod of jobs that move it. */
#pragma once
#include "model/model.h"
#include "rod/front/curves.h"
#include "rod/front/loads.h"
#include "rod/front/properties.h"
#include "rod/identify.h"
#include "rod/rod.h"

/* What varies along a strand, at its stations. */
typedef struct RodVaried {
    RodSection *unit, *section; /* [stations] of 1 Pa, and with Young's modulus; owned */
    double *young;              /* [stations] Pa; owned                                */
} RodVaried;

typedef struct RodModel {
    double coercivity; /* A/m, of what it is magnetised with; NAN: not known */
    int strand_count;
    RodCurve *curves;  /* [strand] what was given; NULL: natural strains were                     */
    RodFrame **frames; /* [strand][stations]; NULL: of poses                                      */
    RodFrame *clamps;  /* [strand] of poses: the clamps' material frames                          */
    RodDraws *draws;   /* [strand] of poses                                                       */
    double *times;     /* [strand] s, where the curves are those of a moving rod, and             */
    Vec3 **inertia;    /* [strand][stations] its inertia and drag as loads, N/m; else NULL        */
    RodProperties properties;
    double young;                   /* Pa, the largest one along it                                     */
    RodSection section, unit;       /* with its modulus, and with 1 Pa: of each number the largest one  */
    RodVaried *varied;              /* [strand], or that of a rod without a curve; NULL: nothing varies */
    double outline[ROD_OUTLINE][2]; /* m: the section's at the first end (rod_properties_outline) */
    RodLoadList list;     /* what the scene says of loads                                             */
    RodPointLoad *points; /* [strand][list.count], each at its time; of rods without curves once  */
    RodLoads loads;       /* on curves, when the job begins, weight included; but for what varies       */
    Vec3 line;            /* line loads without weight, N/m                                             */
    Vec3 **
        along; /* [strand] N/m, what varies along a curve, [stations], inertia and drag included, and then along
                       each of its draws; NULL: nothing                                           */
    Vec3 magnetic;  /* of loads.end what is no force: a field's couple on the magnetisation, N     */
    double flux[3]; /* T, of an inversion                                                        */

    /* Of jobs that move it. */
    Rod *rod;
    RodLayout layout;
    double *natural; /* [nodes][3] places of the natural shape, m                                 */
    bool held;       /* `end` says where the last node is                                         */
    Vec3 end_position;
    Quat end_frame;
    RigidMove first_moves,
        last_moves;  /* how what holds them moves and turns, all first ends as one rigid thing; owned */
    RodStrand *base; /* [strands] where the first ends are before they move; owned; NULL: they stay */
    bool preview;    /* by the position-based solver                                               */
    double *moving;  /* the state that it goes on from (pbd_rod_get_state); NULL: from rest, in model->x */
} RodModel;

/* Curves, section and loads of rod_scene(scene); NULL after a refusal. */
RodModel *rod_model_create(const Scene *scene, const Build *b);
void rod_model_destroy(RodModel *model);

/* m: of the rod, or the longest strand. */
double rod_model_longest(const RodModel *model);

/* Of a strand, at its stations. */
RodSections rod_model_sections(const RodModel *model, int strand);

/* Finds what the rod is made of along its strands, of the scene's length without curves. */
bool rod_model_take_properties(RodModel *model, const RodScene *scene, const Build *b);

/* A discrete rod takes the sections of the strands from that one on, and p their Young's moduli, where they vary. */
void rod_model_put_sections(const RodModel *model, int strand, Rod *rod);
void rod_model_put_young(const RodModel *model, int strand, const Rod *rod, double *p);
void rod_model_clear_varied(RodModel *model);

/* Do all point loads act on a rod of that length? */
bool rod_model_check_points(const RodModel *model, const Build *b, double length);

/* Of an identification: its poses, poses[strand_count], and loads. */
RodIdentifyDef rod_model_poses(const RodModel *model, const RodScene *scene, RodPose *poses);

/* Refuses what a preview does not know. */
bool rod_model_check_preview(const RodModel *model, const Scene *scene, YamlFile *file);

/* Rows of a frame, tangent, n1, n2, made orthonormal; refused where they are further off than 1e-3. */
bool rod_model_frame(const Build *b, const char *at, const double (*rows)[3], RodFrame *frame);

/* Three numbers for each element, values[elements][3]. */
bool rod_model_vectors(const Build *b, const char *at, const VectorScene *scene, const Rod *rod,
                       double *values);

/* The time of a curve, s. */
double rod_model_time(const RodModel *model, int strand, double time);

/* The loads on a curve. */
RodLoads rod_model_on_curve(const RodModel *model, int strand);

/* What acts on a discrete rod, to be made with it: potentials are the model's still. */
RodActs rod_model_acts(const RodModel *model);

/* p[params] of a discrete rod, of the strands from that one on: Young's modulus, weight, loads at that time and damping; all
 * else 0. curves[strands]: where the rod is known to be (NULL: nowhere). False and a sentence where a formula is not finite. */
bool rod_model_loads(const RodModel *model, int strand, const Rod *rod, const RodScene *scene,
                     const RodCurve *curves, double time, double *p, Error *err);

/* p[params] of the discrete rod: material, magnetisation and loads; natural strains too unless a curve was
 * given. */
bool rod_model_params(const RodModel *model, const Scene *scene, const Build *b, double *p);
