/* What Lagrange multipliers hold, while it is far from where it is to be: an end that is to be brought to its place. */
#include "solve/newton_private.h"
#include <math.h>

static const double PUSHED = 0.1; /* part of a gap's force: a change by more is much (system_gap) */

double gap_energy(const Search *s)
{
    double energy = 0;
    for (int i = 0; s->open && i < s->n; i++) {
        double compliance = system_compliance(s->sys, i), change = s->trial_gradient[i] - s->gap[i];
        if (compliance > 0) energy += change * change / (2 * compliance);
    }
    return energy;
}

void gap_pull(Search *s)
{
    for (int i = 0; s->open && i < s->n; i++)
        if (system_compliance(s->sys, i) > 0)
            s->trial[i] += (s->trial_gradient[i] - s->gap[i]) / system_compliance(s->sys, i);
}

double gap_curvature(const Search *s)
{
    double sum = 0;
    for (int i = 0; s->open && i < s->n; i++)
        if (system_compliance(s->sys, i) > 0)
            sum += s->product[i] * s->product[i] / system_compliance(s->sys, i);
    return sum;
}

bool gap_falls(const Search *s)
{
    double before = 0, after = 0;
    for (int i = 0; system_gap(s->sys) > 0 && i < s->n; i++) {
        if (system_compliance(s->sys, i) == 0) continue;
        before = fmax(before, fabs(s->gap[i]));
        after = fmax(after, fabs(s->trial_gradient[i]));
    }
    return after < before / 2;
}

void gap_note(Search *s)
{
    s->open = system_gap(s->sys) > 0 && system_force_change(s->sys, s->step) > PUSHED;
    for (int i = 0; system_gap(s->sys) > 0 && i < s->n; i++) s->gap[i] = s->gradient[i];
}

void gap_take_multipliers(Search *s)
{
    if (system_multiplier_count(s->sys) == 0) return;
    for (int i = 0; i < s->n; i++)
        if (system_is_multiplier(s->sys, i)) {
            double compliance = system_compliance(s->sys, i);
            s->change[i] = s->step[i];
            if (s->open && compliance > 0)
                s->x[i] += s->gap[i] / compliance;
            else if (!s->open)
                s->x[i] += s->step[i];
            s->step[i] = 0;
        }
    s->now = system_gradient(s->sys, &s->at, s->gradient);
    s->info.evaluations++;
}

void gap_keep_multipliers(Search *s, double part)
{
    for (int i = 0; s->open && i < s->n; i++) {
        if (!system_is_multiplier(s->sys, i)) continue;
        double compliance = system_compliance(s->sys, i);
        s->x[i] += part * s->change[i] - (compliance > 0 ? s->gap[i] / compliance : 0);
    }
}
