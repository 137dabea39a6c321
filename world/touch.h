/* touch.h - what acts between the two features of a pair: the potential of self_contact.h and what it depends on. */
#pragma once
#include "world/neighbours.h"

/* Of pair k of a list, at its own x[12]. Where `acts` is false all is 0. */
typedef struct Touch {
    bool acts, edges;
    Distance at;
    double scale, range, parallel; /* stiffness times w, J; D, m; |a x b|^2 from which on m is 1, m^4  */
    double d;                      /* m                                                               */
    double psi, slope, curve;      /* psi, dpsi/de, d2psi/de2                                          */
    double m, m_slope[DISTANCE_DOFS];
} Touch;

Touch touch_at(const Neighbours *n, const PairList *list, int k, double stiffness,
               const double x[DISTANCE_DOFS]);

double touch_energy(const Touch *touch);

/* N = -dE/dd >= 0. */
double touch_force(const Touch *touch);

/* dE/dx to g; where H is not NULL, d2E/dx2 to its lower triangle, by rows. */
void touch_slopes(const Touch *touch, const double x[DISTANCE_DOFS], double g[DISTANCE_DOFS],
                  double H[DISTANCE_LOWER]);

/* d2E/dx2 of a distance that is linear: of the normal force's change alone. Positive, and all of it where features do not turn. */
void touch_convex(const Touch *touch, const double x[DISTANCE_DOFS], double H[DISTANCE_LOWER]);

/* Normal force, weights of the nearest points and direction between them; changes of these or, backwards, derivatives to
 * them. */
typedef struct Grip {
    double N, w[4], n[3];
} Grip;

Grip touch_grip(const Touch *touch);
Grip touch_grip_change(const Touch *touch, const double x[DISTANCE_DOFS], const double dx[DISTANCE_DOFS]);
void touch_grip_back(const Touch *touch, const double x[DISTANCE_DOFS], const Grip *to,
                     double dx[DISTANCE_DOFS]);
