/* scene.h - what a scene says of a shell. */
#pragma once
#include "model/rows.h"

typedef struct ShellScene {
    MeshScene mesh;
    PoseScene *pose;
    VelocityScene *velocity;
    double poisson, coercivity, damping, gravity[3];
    NumberScene thickness, young, density, fold;
    VectorScene magnetization;
    int bending, material; /* BendingModel, MembraneMaterial */
} ShellScene;

extern const YamlTable shell_table;
extern const BodyRow shell_body; /* body.c */

const ShellScene *shell_scene(const Scene *scene);
