/* verb.h - the program's verbs. Each parses its own options and returns an exit code (RunStatus); main.c has
 * the table. */
#pragma once
#include "base/error.h"
#include "cli/options.h"
#include "io/result.h"
#include "job/run.h"

int verb_run(int argc, char **argv);
int verb_sweep(int argc, char **argv);
int verb_check(int argc, char **argv);
int verb_info(int argc, char **argv);
int verb_export(int argc, char **argv);
int verb_picture(int argc, char **argv);
int verb_report(int argc, char **argv);
int verb_schema(int argc, char **argv);
int verb_mesh(int argc, char **argv);

/* ---- What verbs share ---- */

/* "slender: sentence" on the error stream; returns the code. */
int verb_fail(int code, const char *sentence);

/* A scene file, the assignments (NULL: none) made and its table filled in: false after printing what is wrong. Clear
 * the scene and destroy the file in any case. */
bool verb_load_scene(const char *path, const Settings *settings, YamlFile **file, Scene *scene);

/* The model of a scene; NULL after printing what is wrong. Warnings about the mesh are printed. */
Model *verb_build_model(const Scene *scene, YamlFile *file);
