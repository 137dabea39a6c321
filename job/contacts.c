#include "job/contacts.h"
#include "base/memory.h"
#include "model/forces.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

Contacts contacts_create(const Model *model, const Case *load_case)
{
    Contacts c = {.model = model, .load_case = load_case, .world = model->world};
    size_t dofs = (size_t)system_dof_count(load_case->sys);
    c.dofs = (int)dofs;
    c.before = mem_alloc(dofs, sizeof *c.before);
    c.v = mem_alloc(dofs, sizeof *c.v);
    if (model->support_count) {
        c.held = mem_alloc(3 * (size_t)model->point_count, sizeof *c.held);
        c.support = mem_alloc((size_t)model->support_count, sizeof *c.support);
        if (model->body->ops->couples) c.couple = mem_alloc((size_t)model->support_count, sizeof *c.couple);
    }
    if (!c.world) return c;
    c.gauge = world_gauge_create(c.world);
    c.sums.contact.force = mem_alloc((size_t)c.world->obstacle_count, sizeof *c.sums.contact.force);
    c.sums.contact.point = mem_alloc(dofs, sizeof *c.sums.contact.point);
    return c;
}

void contacts_destroy(Contacts *contacts)
{
    world_gauge_destroy(contacts->gauge);
    mem_free(contacts->before);
    mem_free(contacts->v);
    mem_free(contacts->held);
    mem_free(contacts->support);
    mem_free(contacts->couple);
    mem_free(contacts->sums.contact.force);
    mem_free(contacts->sums.contact.point);
}

/* A new step, or part of one: what is summed over all parts stays. */
static void reset(Contacts *c, double friction, double water, Pierced pierced)
{
    double(*force)[3] = c->sums.contact.force, *point = c->sums.contact.point;
    memset(force, 0, (size_t)c->world->obstacle_count * sizeof *force);
    memset(point, 0, (size_t)c->dofs * sizeof *point);
    c->sums = (WorldSums){.contact = {.force = force, .point = point, .friction = friction},
                          .water = water,
                          .pierced = pierced};
}

void contacts_start(Contacts *c, const State *state)
{
    memcpy(c->before, state->x, (size_t)c->dofs * sizeof *c->before);
    memcpy(c->v, state->v, (size_t)c->dofs * sizeof *c->v);
}

void contacts_begin(Contacts *contacts)
{
    if (contacts->world) reset(contacts, 0, 0, (Pierced){0});
}

static void meet(Contacts *c, const Snapshot *shot)
{
    Point at = model_point(shot);
    const double *place = shot->at.x + c->world->body.first;
    Pierced before = c->sums.pierced;
    reset(c, c->sums.contact.friction, c->sums.water, before);
    world_gauge_measure(c->gauge, &at, &c->sums);
    c->pierced += c->sums.pierced.count - before.count;
    c->deepest = fmax(c->deepest, c->sums.contact.depth);
    c->longest = fmax(c->longest, world_longest_edge(c->world, place));
}

static void hold(Contacts *c, Snapshot *shot)
{
    c->model->body->ops->supports(c->model, shot, c->held);
    shot->held = c->held;
    model_support_forces(c->model, shot, c->support);
    if (c->couple) model_support_couples(c->model, shot, c->couple);
}

void contacts_add(Contacts *c, const State *state, double dt, const double *p)
{
    bool implicit = c->world && c->world->implicit;
    StepStart from = {c->before, c->v, implicit ? state->x : NULL, dt};
    Snapshot shot = {.load_case = c->load_case, .p = p, .at = *state, .from = &from};
    if (c->world) meet(c, &shot);
    if (c->held) hold(c, &shot);
    c->stepped = true;
    contacts_start(c, state);
}

void contacts_show(const Contacts *c, Snapshot *shot)
{
    if (c->world) shot->felt = &c->sums;
    if (c->stepped) shot->held = c->held;
}

/* What the world has to say, arrays[CONTACTS_ROWS - 2]; their number. */
static int met_history(const Contacts *c, Array *arrays)
{
    const WorldSums *sums = &c->sums;
    int count = 0;
    if (c->world->obstacle_count) {
        arrays[count++] = array_float("contacts", "", &sums->contact.touching, 0, 0, 0);
        arrays[count++] = array_float("contact_depth", "m", &sums->contact.depth, 0, 0, 0);
        arrays[count++] =
            array_float("contact_force", "N", sums->contact.force[0], 2, c->world->obstacle_count, 3);
    }
    if (c->world->rubs) arrays[count++] = array_float("friction_work", "J", &sums->contact.friction, 0, 0, 0);
    if (c->world->self) {
        arrays[count++] = array_float("self_contacts", "", &sums->pairs, 0, 0, 0);
        arrays[count++] = array_float("self_distance", "m", &sums->self.distance, 0, 0, 0);
        arrays[count++] = array_float("crossings", "", &sums->crossings, 0, 0, 0);
    }
    if (c->world->wet) arrays[count++] = array_float("water_work", "J", &sums->water, 0, 0, 0);
    return count;
}

int contacts_history(const Contacts *c, Array arrays[CONTACTS_ROWS])
{
    int count = c->world ? met_history(c, arrays) : 0;
    if (c->held)
        arrays[count++] = array_float("support_force", "N", c->support[0], 2, c->model->support_count, 3);
    if (c->couple)
        arrays[count++] = array_float("support_couple", "N m", c->couple[0], 2, c->model->support_count, 3);
    return count;
}

void contacts_add_row(const Contacts *c, const char *prefix, int step, int steps, double *rows[CONTACTS_ROWS],
                      Arrays *list)
{
    Array now[CONTACTS_ROWS];
    int count = contacts_history(c, now);
    for (int k = 0; k < count; k++) {
        size_t each = array_count(&now[k]);
        if (step == 1) rows[k] = arrays_numbers(list, (size_t)steps * each);
        memcpy(rows[k] + (size_t)(step - 1) * each, now[k].data, each * sizeof(double));
        if (step < steps) continue;
        char *name = arrays_keep(list, mem_format("%s%s", prefix, now[k].name));
        Array all = array_float(name, now[k].unit, rows[k], 1 + now[k].rank, steps, now[k].dims[0]);
        all.dims[2] = now[k].dims[1];
        arrays_add(list, all);
    }
}

static const char *piece_name(const World *world)
{
    return world->body.face_count ? "face" : "element";
}

void contacts_tell(Contacts *c, const Host *host, int step, int passed)
{
    if (!c->world) return;
    const Pierced *pierced = &c->sums.pierced;
    double crossings = c->sums.crossings;
    if (pierced->count && c->pierced == pierced->count)
        host_warn(host,
                  "step %d: obstacle '%s' goes through %s %d, however short the step is made: between the "
                  "places where contact is felt (vertices, middles of edges and faces), or faster than the "
                  "body can follow",
                  step, c->world->obstacles[pierced->obstacle].name, piece_name(c->world), pierced->face);
    bool through_itself = passed && !pierced->count;
    if (through_itself && c->pierced++ == 0)
        host_warn(host, "step %d: the body goes through itself, however short the step is made", step);
    if (crossings > 0 && !c->crosses)
        host_warn(host, "step %d: the body passes through itself in %g place%s", step, crossings,
                  crossings == 1 ? "" : "s");
    c->crosses = crossings > 0;
}

bool contacts_pierced(const Contacts *c)
{
    return c->pierced > 0 || c->sums.crossings > 0;
}

static const double DEEP = 0.05; /* of the thickness: more is no contact of thin things */

void contacts_doubt(const Contacts *c, const Host *host)
{
    if (!c->world || c->world->obstacle_count == 0) return;
    double thickness = c->world->body.thickness;
    if (c->deepest > DEEP * thickness)
        host_say(
            host,
            "up to %.2g m deep in an obstacle, %.2g of the %g m that contact.stiffness is made for: what "
            "presses there is more than it holds, as between obstacles nearer to each other than the "
            "body is thick",
            c->deepest, c->deepest / thickness, thickness);
    for (int k = 0; k < c->world->obstacle_count; k++)
        if (world_slips_between(c->world, k, c->longest))
            host_say(host,
                     "edges were up to %.2g m long: obstacle '%s', with details of %.2g m, may have passed "
                     "between "
                     "the places where contact is felt (vertices, middles of edges and faces)",
                     c->longest, c->world->obstacles[k].name, c->world->obstacles[k].feature);
}

static void recall_numbers(const Array *stored, double *numbers, size_t count)
{
    if (stored->data && array_count(stored) == count) memcpy(numbers, stored->data, count * sizeof *numbers);
}

bool contacts_recall(Contacts *c, Journal *journal, int step, Error *err)
{
    if (!c->world) return true;
    enum { ROWS = 5 };
    ContactSums *sums = &c->sums.contact;
    static const char *const names[ROWS] = {"contacts", "contact_depth", "contact_force", "pierced",
                                            "crossings"};
    double *const numbers[ROWS] = {&sums->touching, &sums->depth, sums->force[0], &c->pierced,
                                   &c->sums.crossings};
    const size_t counts[ROWS] = {1, 1, 3 * (size_t)c->world->obstacle_count, 1, 1};
    for (int k = 0; k < ROWS; k++) {
        Array stored;
        if (!journal_find(journal, "evaluation", step, names[k], &stored, err)) return false;
        recall_numbers(&stored, numbers[k], counts[k]);
        array_clear(&stored);
    }
    c->crosses = c->sums.crossings > 0;
    return true;
}

const char *contacts_text(const Contacts *c, char text[64])
{
    text[0] = 0;
    if (c->world && c->world->obstacle_count)
        snprintf(text, 64, ", %g contact%s", c->sums.contact.touching,
                 c->sums.contact.touching == 1 ? "" : "s");
    return text;
}
