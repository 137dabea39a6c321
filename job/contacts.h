/* contacts.h - what a motion says of what its body meets and of what holds it: a row for each step of time, and the forces of
 * a state. */
#pragma once
#include "io/arrays.h"
#include "job/run.h"

/* The steps of a body that meets something, or is held. */
typedef struct Contacts {
    const Model *model;
    const Case *load_case; /* which moves */
    const World *world;    /* NULL: it meets nothing */
    WorldGauge *gauge;     /* of the world                                              */
    int dofs;
    double *before, *v; /* [dofs] where a step begins, and how fast               */
    WorldSums sums;     /* of the step: forces and counts of its end, works of its parts; owns its vectors */
    double *held;       /* [3*points] N, what holds each of them at the end of the step; NULL: nothing does */
    double (*support)[3];    /* [supports] N, their sums (model_support_forces)                             */
    double (*couple)[3];     /* [supports] N m (model_support_couples); NULL: no frames are held       */
    bool stepped;            /* a step was made, and all of that is known */
    double pierced;          /* faces that obstacles went through, of all steps */
    bool crosses;            /* it is through itself at the end of the last step */
    double deepest, longest; /* m, of all steps: depth in an obstacle, edge */
} Contacts;

/* Both are borrowed. */
Contacts contacts_create(const Model *model, const Case *load_case);
void contacts_destroy(Contacts *contacts);

/* Where the first step begins, velocities included. */
void contacts_start(Contacts *contacts, const State *state);

/* A new step; its parts, one at least, each with the state that it has reached, v included. */
void contacts_begin(Contacts *contacts);
void contacts_add(Contacts *contacts, const State *state, double dt, const double *p);

/* The last step's end, as long as there is no other one: what it met and what holds it there. */
void contacts_show(const Contacts *contacts, Snapshot *shot);

enum { CONTACTS_ROWS = 10 };

/* The step as arrays for history/, borrowed from contacts; their number. */
int contacts_history(const Contacts *contacts, Array arrays[CONTACTS_ROWS]);

/* The same in rows of `steps` numbers each: puts a step, from 1 on, into rows, which are the list's, and with the last one
 * adds the arrays to it, named with a prefix. */
void contacts_add_row(const Contacts *contacts, const char *prefix, int step, int steps,
                      double *rows[CONTACTS_ROWS], Arrays *list);

/* Says so where in a step, the first in which one does, an obstacle goes through the body, or the body through itself: in
 * so many of the shortest parts of the step (MarchInfo.passed) something did. */
void contacts_tell(Contacts *contacts, const Host *host, int step, int passed);

/* Has something gone through the body in one of the steps, or is it through itself at the end of the last? */
bool contacts_pierced(const Contacts *contacts);

/* Says what the steps so far cannot be trusted in: what was pressed too deep, or stretched so far that an obstacle fits
 * between the places where contact is felt. */
void contacts_doubt(const Contacts *contacts, const Host *host);

/* Forces and counts of a step from its row of history/, for a run that goes on from it: those on single points are not there.
 */
bool contacts_recall(Contacts *contacts, Journal *journal, int step, Error *err);

/* ", 12 contacts": for progress; static. */
const char *contacts_text(const Contacts *contacts, char text[64]);
