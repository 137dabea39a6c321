#include "io/result_groups.h"
#include "base/memory.h"
#include "io/text.h"
#include <string.h>

static int each_of(int dim)
{
    return dim == 1 ? 2 : 1;
}

void result_groups_add(Arrays *list, const MeshGroup *groups, int count)
{
    if (!count) return;
    int *dim = arrays_keep(list, mem_alloc((size_t)count, sizeof *dim)),
        *offsets = arrays_keep(list, mem_alloc((size_t)count + 1, sizeof *offsets));
    Text names = {0};
    for (int g = 0; g < count; g++) {
        dim[g] = groups[g].dim;
        offsets[g + 1] = offsets[g] + each_of(dim[g]) * groups[g].count;
        text_add(&names, "%s\n", groups[g].name);
    }
    int *members = arrays_keep(list, mem_alloc((size_t)offsets[count], sizeof *members));
    for (int g = 0; g < count; g++)
        if (groups[g].count)
            memcpy(members + offsets[g], groups[g].members,
                   (size_t)(offsets[g + 1] - offsets[g]) * sizeof *members);
    arrays_add(list, array_text("groups/names", arrays_keep(list, names.text)));
    arrays_add(list, array_int("groups/dim", dim, 1, count, 0));
    arrays_add(list, array_int("groups/offsets", offsets, 1, count + 1, 0));
    arrays_add(list, array_int("groups/members", members, 1, offsets[count], 0));
}

/* One group out of the arrays; its name is the line that begins there. False: they are not as they were written. */
static bool take_group(const char **line, int dim, const int *members, int numbers, int limit,
                       MeshGroup *group)
{
    const char *end = strchr(*line, '\n');
    if (!end || numbers < 0 || numbers % each_of(dim)) return false;
    *group = (MeshGroup){.name = mem_format("%.*s", (int)(end - *line), *line),
                         .dim = dim,
                         .count = numbers / each_of(dim),
                         .members = mem_copy(members, (size_t)numbers, sizeof *members)};
    *line = end + 1;
    for (int k = 0; k < numbers; k++)
        if (members[k] < 0 || members[k] >= limit) return false;
    return true;
}

static bool take_groups(const Array *names, const Array *dims, const Array *offsets, const Array *members,
                        const int count[4], MeshFile *file)
{
    int groups = dims->dims[0];
    const int *dim = dims->data, *offset = offsets->data;
    const char *line = names->data;
    if (offsets->dims[0] != groups + 1 || offset[0] != 0 || offset[groups] != members->dims[0]) return false;
    file->groups = mem_alloc((size_t)groups, sizeof *file->groups);
    for (int g = 0; g < groups; g++) {
        if (dim[g] < 0 || dim[g] > 3 || offset[g + 1] < offset[g] || offset[g + 1] > members->dims[0])
            return false;
        int limit = count[dim[g] == 1 ? 0 : dim[g]];
        file->group_count = g + 1;
        if (!take_group(&line, dim[g], (const int *)members->data + offset[g], offset[g + 1] - offset[g],
                        limit, &file->groups[g]))
            return false;
    }
    return true;
}

bool result_groups_read(Result *result, const int count[4], MeshFile *file, Error *err)
{
    Array names = {0}, dim = {0}, offsets = {0}, members = {0};
    if (!result_has(result, "slender/groups/names")) return true;
    bool ok = result_read_as(result, "slender/groups/names", ARRAY_TEXT, 1, 0, &names, err) &&
              result_read_as(result, "slender/groups/dim", ARRAY_INT32, 1, 0, &dim, err) &&
              result_read_as(result, "slender/groups/offsets", ARRAY_INT32, 1, 0, &offsets, err) &&
              result_read_as(result, "slender/groups/members", ARRAY_INT32, 1, 0, &members, err);
    ok = ok && (take_groups(&names, &dim, &offsets, &members, count, file) ||
                error_set(err, "slender/groups is not as slender writes it"));
    Array *arrays[] = {&names, &dim, &offsets, &members};
    for (int k = 0; k < 4; k++) array_clear(arrays[k]);
    return ok;
}
