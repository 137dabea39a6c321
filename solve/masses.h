/* masses.h - lumped masses of points: numbers, or sums of what densities and thicknesses in p make of areas. */
#pragma once

/* A point's share of what has an area: p[density] p[thickness] area/3, kg. */
typedef struct MassPart {
    int density, thickness; /* entries of p */
    double area;            /* m^2          */
} MassPart;

typedef struct Masses {
    int count;
    double *fixed;   /* [count] kg; NULL: all are of parts; owned         */
    int *first;      /* [count + 1] where each point's parts begin; owned */
    MassPart *parts; /* owned                                             */
} Masses;

/* Fixed ones, all 0, to be filled in; mass[count] in kg, copied. */
Masses masses_zero(int count);
Masses masses_fixed(int count, const double *mass);

/* Of triangles, which give each corner a third: the parts of a point in the order of the triangles. Triangle f has entries
 * density + f and thickness + f. */
Masses masses_of_faces(int count, int face_count, const int (*faces)[3], const double *area, int density,
                       int thickness);

Masses masses_copy(const Masses *masses);
void masses_clear(Masses *masses);

/* Of all points, mass[count] in kg. */
void masses_all(const Masses *masses, const double *p, double *mass);

/* Of a point, kg; its change with p, dp laid out as p; dp += amount times its derivative. */
double masses_at(const Masses *masses, int point, const double *p);
double masses_change(const Masses *masses, int point, const double *p, const double *dp);
void masses_add_param(const Masses *masses, int point, const double *p, double amount, double *dp);
