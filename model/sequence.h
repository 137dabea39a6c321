/* sequence.h - the stages of the scene's key `sequence`: a list, or the two ends of ranges; and the load steps of each. */
#pragma once
#include "model/model.h"
#include "optim/case.h"

/* How many stages it says, 2 of ranges; one of them, what it does not say as in a list; the key at which it says that. */
int sequence_said(const Scene *scene);
StageScene sequence_stage(const Scene *scene, int k);
Key sequence_key(const Scene *scene, int k, const char *what);

/* *count: of all its stages, those between the ends of ranges too. False after a refusal. */
bool sequence_check(const Scene *scene, YamlFile *file, int *count);

/* A case with the two ends of a range, p[size] each, gets so many stages in equal parts; what both have alike has all its
 * bits in all. */
void sequence_fill(Case *c, int count, int size);

/* Over how many load steps a stage comes on; and how many of them are frames: 1, its end. */
int sequence_load_steps(const Model *model, const Scene *scene);
int sequence_frames_each(const Scene *scene);
