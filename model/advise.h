/* advise.h - what is doubtful about any body's scene, before the work: warnings into the model's report, which every use
 * of a scene says. What is doubtful about one kind of body is said by its row (BodyOps.advise). */
#pragma once
#include "model/model.h"

/* The largest flux density that the body is in at the start of a case, with a stage's p: over the whole time of a motion, of
 * an unknown one with its bounds. T; 0 where it feels none. Of many points and moments some are asked. */
double advise_largest_flux(const Model *model, const Scene *scene, const Case *c, const double *p);

/* A value, of a quantity with that unit, that no such body has: most likely it was meant in another unit. NAN is none. */
void advise_value(Model *model, const char *name, const char *unit, double value);

/* Values outside of what there is, fields that no magnets give, and targets of another size than the body. */
void model_advise(Model *model, const Scene *scene);
