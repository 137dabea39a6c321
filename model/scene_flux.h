/* scene_flux.h - what a scene says of the flux density around its body, and of what moves in time. */
#pragma once

typedef struct WhereScene WhereScene; /* scene.h */

/* Three numbers in time. */
typedef struct PathScene {
    char **formula, *file;
    int formula_count;
} PathScene;

typedef struct DipoleScene {
    double at[3], moment[3];
} DipoleScene;

/* A block of a size, a cylinder, or what is small beside its distance. */
typedef struct MagnetScene {
    double at[3], remanence[3], volume, size[3], axis[3], radius, length;
} MagnetScene;

typedef struct CoilScene {
    double at[3], axis[3], radius, length, size[2], current, turns;
} CoilScene;

typedef struct FluxMapScene {
    char *file;
    double scale;
} FluxMapScene;

/* One source; a flux density is a list of them, summed. */
typedef struct FluxScene {
    char *name;
    double value[3];
    char **formula, *file;
    WhereScene *where;
    DipoleScene *dipole;
    MagnetScene *magnet;
    CoilScene *coil;
    FluxMapScene *map;
    PathScene *move, *turn;
    int formula_count, where_count;
} FluxScene;
