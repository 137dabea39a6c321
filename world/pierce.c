#include "world/pierce.h"
#include <math.h>
#include <string.h>

/* Of the inradius: so deep it has gone through; and so small is a part that is looked at as a whole. */
static const double DEEP = 0.5, FINE = 0.125;

/* A face's corners, in the obstacle's own frame, where the step begins and where it ends. */
typedef struct Prism {
    int corners;
    double x[2][3][3];
} Prism;

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* The middle of its corners, and the radius of a ball around it in which all of the prism lies. */
static double ball_around(const Prism *prism, double middle[3])
{
    double radius = 0;
    for (int i = 0; i < 3; i++) {
        middle[i] = 0;
        for (int c = 0; c < prism->corners; c++) middle[i] += prism->x[0][c][i] + prism->x[1][c][i];
        middle[i] /= 2 * prism->corners;
    }
    for (int c = 0; c < prism->corners; c++)
        radius = fmax(radius, fmax(distance(prism->x[0][c], middle), distance(prism->x[1][c], middle)));
    return radius;
}

static void halfway(const double a[3], const double b[3], double middle[3])
{
    for (int i = 0; i < 3; i++) middle[i] = (a[i] + b[i]) / 2;
}

/* Across its longest edge, in space or in time. */
static void split(const Prism *prism, Prism half[2])
{
    double longest = -1;
    int from = 0, to = 0; /* corners; equal: in time */
    for (int c = 0; c < prism->corners; c++) {
        int next = (c + 1) % prism->corners;
        double way = distance(prism->x[0][c], prism->x[1][c]);
        if (way > longest) longest = way, from = to = c;
        for (int t = 0; t < 2; t++) {
            double edge = distance(prism->x[t][c], prism->x[t][next]);
            if (edge > longest) longest = edge, from = c, to = next;
        }
    }
    half[0] = half[1] = *prism;
    for (int c = 0; from == to && c < prism->corners; c++) {
        halfway(prism->x[0][c], prism->x[1][c], half[0].x[1][c]);
        memcpy(half[1].x[0][c], half[0].x[1][c], sizeof half[1].x[0][c]);
    }
    for (int t = 0; from != to && t < 2; t++) {
        halfway(prism->x[t][from], prism->x[t][to], half[0].x[t][to]);
        memcpy(half[1].x[t][from], half[0].x[t][to], sizeof half[1].x[t][from]);
    }
}

typedef enum Depth { CLEAR, UNKNOWN, DEEP_IN } Depth;

/* Of a prism, from its middle alone: in a ball phi changes by its steepest slope times the radius at most. What is small
 * is as its middle. */
static Depth look(const Obstacle *obstacle, const Prism *prism)
{
    Gap gap;
    double middle[3], radius = ball_around(prism, middle), level = -DEEP * obstacle->inradius;
    obstacle->ops->gap(obstacle->self, middle, &gap);
    if (gap.value < level) return DEEP_IN;
    bool clear = !(gap.value - radius * fmax(1, obstacle->steepest) < level); /* NaN, too */
    return clear || radius < FINE * obstacle->inradius ? CLEAR : UNKNOWN;
}

/* Is a place of it? [branch and bound] */
static bool is_deep(const Obstacle *obstacle, const Prism *prism)
{
    Prism half[2];
    Depth depth = look(obstacle, prism);
    if (depth != UNKNOWN) return depth == DEEP_IN;
    split(prism, half);
    return is_deep(obstacle, &half[0]) || is_deep(obstacle, &half[1]);
}

/* Where it begins (0) or ends (1). */
static bool is_deep_at(const Obstacle *obstacle, const Prism *prism, int time)
{
    Prism still = *prism;
    memcpy(still.x[1 - time], still.x[time], sizeof still.x[time]);
    return is_deep(obstacle, &still);
}

/* Its end is looked at as the next step's beginning will be: so nothing that goes in slowly is deep at a beginning and was
 * not so before. */
static bool is_pierced(const Obstacle *obstacle, const Prism *prism)
{
    return look(obstacle, prism) != CLEAR && (is_deep(obstacle, prism) || is_deep_at(obstacle, prism, 1)) &&
           !is_deep_at(obstacle, prism, 0);
}

Pierced pierce_find(const Poses *poses, const Samples *faces, const double *from, const double *to)
{
    Pierced found = {0};
    for (int k = 0; k < poses->count; k++) {
        if (!isfinite(poses->obstacles[k].inradius)) continue;
        for (int f = 0; f < faces->count; f++) {
            Prism prism = {.corners = faces->corners};
            for (int c = 0; c < faces->corners; c++) {
                int place = faces->first + 3 * faces->vertices[f * faces->corners + c];
                rigid_own_place(&poses->start[k], from + place, prism.x[0][c]);
                rigid_own_place(&poses->end[k], to + place, prism.x[1][c]);
            }
            if (!is_pierced(&poses->obstacles[k], &prism)) continue;
            if (found.count++ == 0) found.obstacle = k, found.face = f;
        }
    }
    return found;
}
