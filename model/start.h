/* start.h - a model that starts from a state which another run has left in its result (the scene's key `start`).
 *
 * Opened before the body is made, for a motion goes on from the state's time; taken when its cases are there. Refusals
 * are at the key. */
#pragma once
#include "model/model.h"

/* Nothing where the scene has no `start`; else model->start, and model->time of a motion. */
bool start_open(Model *model, const Scene *scene, YamlFile *file);

/* Puts each case where the result leads: its state, the loads that act there, and where its factor stands. The body must
 * be the one that the result is of (BodyOps.known_by, BodyOps.take_state). */
bool start_take(Model *model, const Scene *scene, YamlFile *file);

void start_close(Start *start);
