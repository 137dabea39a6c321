#include "model/sequence.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

enum { RANGES = 4 };

int sequence_said(const Scene *scene)
{
    const SequenceScene *from = scene->sequence;
    return !from ? 0 : from->stages ? from->stages_count : 2;
}

StageScene sequence_stage(const Scene *scene, int k)
{
    const SequenceScene *from = scene->sequence;
    if (from->stages) return from->stages[k];
    StageScene stage = {.gravity = {NAN, NAN, NAN}, .time = NAN};
    const FluxRange *flux = from->flux_density;
    const LoadsRange *loads = from->loads;
    if (flux) stage.flux_density = k ? flux->to : flux->from;
    if (flux) stage.flux_density_count = k ? flux->to_count : flux->from_count;
    if (loads) stage.loads = k ? loads->to : loads->from;
    if (loads) stage.loads_count = k ? loads->to_count : loads->from_count;
    if (from->gravity)
        memcpy(stage.gravity, k ? from->gravity->to : from->gravity->from, sizeof stage.gravity);
    if (from->time) stage.time = k ? from->time->to : from->time->from;
    return stage;
}

Key sequence_key(const Scene *scene, int k, const char *what)
{
    if (scene->sequence->stages) return key("sequence.stages[%d].%s", k, what);
    return key("sequence.%s.%s", what, k ? "to" : "from");
}

bool sequence_check(const Scene *scene, YamlFile *file, int *count)
{
    const SequenceScene *from = scene->sequence;
    *count = from->stages_count;
    if (from->stages) return *count > 0 || yaml_refuse(file, "sequence", "a sequence has one stage or more");
    static const char *const names[RANGES] = {"flux_density", "loads", "gravity", "time"};
    const int counts[RANGES] = {from->flux_density ? from->flux_density->count : YAML_ABSENT,
                                from->loads ? from->loads->count : YAML_ABSENT,
                                from->gravity ? from->gravity->count : YAML_ABSENT,
                                from->time ? from->time->count : YAML_ABSENT};
    for (int k = 0; k < RANGES; k++) {
        if (counts[k] == YAML_ABSENT) continue;
        if (*count && counts[k] != *count)
            return yaml_refuse(file, key("sequence.%s.count", names[k]).text,
                               "ranges go side by side: count is %d here and %d of another", counts[k],
                               *count);
        *count = counts[k];
    }
    return *count ||
           yaml_refuse(file, "sequence",
                       "a sequence is a list of stages, or has ranges with a `count`: flux_density: "
                       "{from: [0, 0, 0], to: [0, 0, 20 mT], count: 9}");
}

static double between(double from, double to, int k, int last)
{
    return from + (to - from) * k / last;
}

void sequence_fill(Case *c, int count, int size)
{
    Stage first = c->stages[0], end = c->stages[1];
    c->stages = mem_resize(c->stages, 2, (size_t)count, sizeof *c->stages);
    c->stage_count = count;
    c->stages[count - 1] = end;
    for (int k = 1; k < count - 1; k++) {
        Stage *stage = &c->stages[k];
        *stage = (Stage){mem_copy(first.p, (size_t)size, sizeof *first.p),
                         between(first.time, end.time, k, count - 1)};
        for (int i = 0; i < size; i++) stage->p[i] = between(first.p[i], end.p[i], k, count - 1);
    }
}

int sequence_load_steps(const Model *model, const Scene *scene)
{
    return scene->load_steps.mode < 0 ? scene->load_steps.count : model->load_steps;
}

int sequence_frames_each(const Scene *scene)
{
    return scene->load_steps.frames ? scene->load_steps.count : 1;
}
