#include "solve/patches.h"
#include "base/memory.h"
#include <stdlib.h>
#include <string.h>

/* A patch is full with so many different entries: they take 200 kB, and one more slice of all terms has numbers left. */
enum { PATCH_ENTRIES = 40000, MAX_LOWER = TERM_LOWER(TERM_MAX_DOF, 0) };

/* Gives out places while patches are made. */
typedef struct Register {
    Places *places;
    int *last; /* [targets] the last place of each; of the patch at hand if not before begin */
    int begin;
} Register;

static void append(Places *places, int target)
{
    if (places->count == places->room) {
        int room = 2 * places->room + 1024;
        places->target = mem_resize(places->target, (size_t)places->room, (size_t)room, sizeof(int));
        places->room = room;
    }
    places->target[places->count++] = target;
}

static Register register_open(Places *places, int targets)
{
    if (places->count == 0) append(places, -1);
    return (Register){places, mem_alloc((size_t)targets, sizeof(int)), 0};
}

static void register_patch(Register *r)
{
    r->begin = r->places->count;
    append(r->places, -1);
}

static Number number_of(Register *r, int target)
{
    if (r->last[target] < r->begin) {
        r->last[target] = r->places->count;
        append(r->places, target);
    }
    return (Number)(r->last[target] - r->begin);
}

/* Has room for the values of all places, which mean nothing between evaluations; true where it is new. */
static bool make_room_for_values(Places *places)
{
    if (places->value_room >= places->count) return false;
    mem_free(places->values);
    places->value_room = places->room;
    places->values = mem_alloc((size_t)places->value_room, sizeof(double));
    return true;
}

/* All places so far last. */
static void set_lasting(Places *places, int targets)
{
    places->lasting = places->count;
    places->pull = pull_create(targets, places->count, places->target);
}

static void places_destroy(Places *places)
{
    pull_destroy(&places->pull);
    mem_free(places->target);
    mem_free(places->values);
}

void patches_destroy(Patches *patches)
{
    places_destroy(&patches->dofs);
    places_destroy(&patches->entries);
    mem_free(patches->list);
    mem_free(patches->forces);
    mem_free(patches->energies);
    *patches = (Patches){0};
}

/* ---- Division ---- */

/* Are a's dofs the first ones of b, pack by pack? */
static bool begins_with(const Entry *b, const Entry *a)
{
    if (a->changes || b->changes || a->count != b->count || a->size > b->size) return false;
    for (int k = 0; k < a->packs; k++)
        if (memcmp(a->dofs[k * a->size], b->dofs[k * b->size], (size_t)a->size * sizeof *a->dofs))
            return false;
    return true;
}

/* Each term rides with the largest that it can, of equals with the first. */
static void find_hosts(Entry *entries, int term_count)
{
    for (int t = 0; t < term_count; t++) {
        int host = t;
        for (int u = term_count - 1; u >= 0; u--)
            if (entries[u].size >= entries[host].size && begins_with(&entries[u], &entries[t])) host = u;
        entries[t].host = host;
    }
}

/* Patches in the making. */
typedef struct Maker {
    Patches *patches;
    Entry *entries;
    int term_count;
    bool changing; /* of the terms whose elements change */
    int slices; /* of all terms' packs, side by side: neighbours if the terms number their elements alike */
    int slice_numbers; /* that a slice may need at most */
    Register dofs, slots;
    const Sparse *matrix; /* NULL: entries have no places yet */
    const int *unknown;
} Maker;

static bool is_stored(const Maker *m, int t)
{
    return m->entries[t].changes == m->changing && m->entries[t].host == t;
}

static void measure_slices(Maker *m)
{
    for (int t = 0; t < m->term_count; t++) {
        if (!is_stored(m, t)) continue;
        if (m->entries[t].packs > m->slices) m->slices = m->entries[t].packs;
        m->slice_numbers += (m->entries[t].lower + 1) * PACK_LANES;
    }
}

static int slice_begin(const Maker *m, int t, int slice)
{
    return is_stored(m, t) ? (int)((long)slice * m->entries[t].packs / m->slices) : 0;
}

static void number_dofs(Register *r, Entry *entry, int pack)
{
    for (int i = pack * entry->size; i < (pack + 1) * entry->size; i++)
        for (int l = 0; l < PACK_LANES; l++)
            entry->dof_numbers[i][l] =
                pack * PACK_LANES + l < entry->count ? number_of(r, entry->dofs[i][l]) : 0;
}

/* Appends to twice; its room doubles at powers of two. */
static void note_twice(Entry *entry, int pack, int k, int lane)
{
    int count = entry->twice_start[pack + 1]++;
    if ((count & (count - 1)) == 0)
        entry->twice = mem_resize(entry->twice, (size_t)count, 2 * (size_t)count + 1, sizeof *entry->twice);
    entry->twice[count] = (Number)(k * PACK_LANES + lane);
}

/* Where the entries of each lane's element are stored; returns how many lanes there are. */
static int find_slots(const Maker *m, const Entry *entry, int pack, int slots[PACK_LANES][MAX_LOWER])
{
    int lanes = 0;
    for (; lanes < PACK_LANES && pack * PACK_LANES + lanes < entry->count; lanes++) {
        int unknowns[TERM_MAX_DOF];
        for (int i = 0; i < entry->size; i++)
            unknowns[i] = m->unknown[entry->dofs[pack * entry->size + i][lanes]];
        sparse_slots(m->matrix, entry->size, unknowns, slots[lanes]);
    }
    return lanes;
}

static void number_entries(Maker *m, Entry *entry, int pack)
{
    int(*dofs)[PACK_LANES] = &entry->dofs[pack * entry->size], slots[PACK_LANES][MAX_LOWER];
    int lanes = find_slots(m, entry, pack, slots);
    entry->twice_start[pack + 1] = entry->twice_start[pack];
    for (int i = 0, k = 0; i < entry->size; i++)
        for (int j = 0; j <= i; j++, k++)
            for (int l = 0; l < lanes; l++) {
                if (slots[l][k] < 0) continue;
                entry->entry_numbers[(long)pack * entry->lower + k][l] = number_of(&m->slots, slots[l][k]);
                if (i != j && dofs[i][l] == dofs[j][l]) note_twice(entry, pack, k, l);
            }
}

/* The entries of a patch that has its packs. */
static void number_patch(Maker *m, Patch *patch)
{
    register_patch(&m->slots);
    patch->entries = m->slots.begin;
    for (int t = 0; t < m->term_count; t++)
        for (int k = patch->first[t]; k < patch->end[t]; k++) number_entries(m, &m->entries[t], k);
    patch->entry_count = m->slots.places->count - m->slots.begin;
}

static Patch *add_patch(Maker *m, int slice)
{
    Patches *patches = m->patches;
    if (patches->count == patches->room) {
        int room = 2 * patches->room + 16;
        patches->list = mem_resize(patches->list, (size_t)patches->room, (size_t)room, sizeof *patches->list);
        patches->room = room;
    }
    Patch *patch = &patches->list[patches->count++];
    register_patch(&m->dofs);
    *patch = (Patch){.dofs = m->dofs.begin};
    for (int t = 0; t < m->term_count; t++) patch->first[t] = patch->end[t] = slice_begin(m, t, slice);
    if (!m->matrix) return patch;
    register_patch(&m->slots);
    patch->entries = m->slots.begin;
    return patch;
}

/* A slice more, which begins where the patch ends. */
static void extend(Maker *m, Patch *patch, int slice)
{
    for (int t = 0; t < m->term_count; t++) {
        int end = slice_begin(m, t, slice + 1);
        for (; patch->end[t] < end; patch->end[t]++) {
            number_dofs(&m->dofs, &m->entries[t], patch->end[t]);
            if (m->matrix) number_entries(m, &m->entries[t], patch->end[t]);
        }
    }
    patch->dof_count = m->dofs.places->count - m->dofs.begin;
    if (m->matrix) patch->entry_count = m->slots.places->count - m->slots.begin;
}

/* Without a matrix as if all entries of all elements differed. */
static bool is_full(const Maker *m, const Patch *patch, int slices)
{
    int numbers = m->matrix ? patch->entry_count : slices * m->slice_numbers;
    return numbers > PATCH_ENTRIES || numbers + m->slice_numbers > UINT16_MAX;
}

static int compare_targets(const void *a, const void *b)
{
    const int *i = a, *j = b;
    return (i[0] > j[0]) - (i[0] < j[0]);
}

/* Numbers a patch's entries anew as they are stored in the matrix, so that what pulls them reads them in a row. */
static void sort_entries(Maker *m, const Patch *patch)
{
    int count = patch->entry_count, *target = m->slots.places->target + patch->entries;
    int(*pairs)[2] = mem_alloc((size_t)count, sizeof *pairs);
    Number *number = mem_alloc((size_t)count, sizeof *number);
    for (int k = 0; k < count; k++) pairs[k][0] = target[k], pairs[k][1] = k;
    qsort(pairs, (size_t)count, sizeof *pairs, compare_targets); /* the bin has -1 and stays the first */
    for (int k = 0; k < count; k++) target[k] = pairs[k][0], number[pairs[k][1]] = (Number)k;
    for (int t = 0; t < m->term_count; t++)
        for (int k = patch->first[t] * m->entries[t].lower; k < patch->end[t] * m->entries[t].lower; k++)
            for (int l = 0; l < PACK_LANES; l++)
                m->entries[t].entry_numbers[k][l] = number[m->entries[t].entry_numbers[k][l]];
    mem_free(pairs);
    mem_free(number);
}

static void divide(Maker *m)
{
    Patch *patch = NULL;
    measure_slices(m);
    for (int slice = 0, own = 0; slice < m->slices; slice++, own++) {
        if (!patch || is_full(m, patch, own)) {
            if (patch && m->matrix) sort_entries(m, patch);
            patch = add_patch(m, slice);
            own = 0;
        }
        extend(m, patch, slice);
    }
    if (patch && m->matrix) sort_entries(m, patch);
}

static void clear_entry_numbers(Entry *entry)
{
    mem_free(entry->entry_numbers);
    mem_free(entry->twice_start);
    mem_free(entry->twice);
    entry->entry_numbers = NULL, entry->twice_start = NULL, entry->twice = NULL;
}

void entry_clear(Entry *entry)
{
    mem_free(entry->dof_numbers);
    entry->dof_numbers = NULL;
    clear_entry_numbers(entry);
}

static void make_room_for_dofs(Maker *m)
{
    for (int t = 0; t < m->term_count; t++) {
        Entry *entry = &m->entries[t];
        if (!is_stored(m, t)) continue;
        entry_clear(entry);
        entry->dof_numbers =
            mem_alloc((size_t)entry->packs * (size_t)entry->size, sizeof *entry->dof_numbers);
    }
}

static void make_room_for_entries(Maker *m)
{
    for (int t = 0; t < m->term_count; t++) {
        Entry *entry = &m->entries[t];
        if (!is_stored(m, t)) continue;
        clear_entry_numbers(entry);
        entry->entry_numbers =
            mem_alloc((size_t)entry->packs * (size_t)entry->lower, sizeof *entry->entry_numbers);
        entry->twice_start = mem_alloc((size_t)entry->packs + 1, sizeof(int));
    }
}

/* All patches are there. */
static void finish_patches(Patches *patches)
{
    if (make_room_for_values(&patches->dofs)) {
        mem_free(patches->forces);
        patches->forces = mem_alloc((size_t)patches->dofs.value_room, sizeof(double));
    }
    mem_free(patches->energies);
    patches->energies = mem_alloc((size_t)patches->count * SYSTEM_MAX_TERMS, sizeof(double));
}

void patches_create(Patches *patches, Entry *entries, int term_count, const Sparse *matrix, int dof_count,
                    const int *unknown)
{
    *patches = (Patches){0};
    find_hosts(entries, term_count);
    Maker m = {.patches = patches,
               .entries = entries,
               .term_count = term_count,
               .matrix = matrix,
               .unknown = unknown};
    m.dofs = register_open(&patches->dofs, dof_count);
    m.slots = register_open(&patches->entries, sparse_made_nonzeros(matrix));
    make_room_for_dofs(&m);
    make_room_for_entries(&m);
    divide(&m);
    mem_free(m.dofs.last);
    mem_free(m.slots.last);
    patches->lasting = patches->count;
    set_lasting(&patches->dofs, dof_count);
    set_lasting(&patches->entries, sparse_made_nonzeros(matrix));
    make_room_for_values(&patches->entries);
    finish_patches(patches);
}

void patches_change(Patches *patches, Entry *entries, int term_count, int dof_count)
{
    Maker m = {.patches = patches, .entries = entries, .term_count = term_count, .changing = true};
    patches->count = patches->lasting;
    patches->dofs.count = patches->dofs.lasting;
    m.dofs = register_open(&patches->dofs, dof_count);
    make_room_for_dofs(&m);
    divide(&m);
    mem_free(m.dofs.last);
    finish_patches(patches);
}

void patches_place(Patches *patches, Entry *entries, int term_count, const Sparse *matrix, const int *unknown)
{
    Maker m = {.patches = patches,
               .entries = entries,
               .term_count = term_count,
               .changing = true,
               .matrix = matrix,
               .unknown = unknown};
    patches->entries.count = patches->entries.lasting;
    m.slots = register_open(&patches->entries, sparse_nonzeros(matrix));
    make_room_for_entries(&m);
    for (int p = patches->lasting; p < patches->count; p++) number_patch(&m, &patches->list[p]);
    mem_free(m.slots.last);
    make_room_for_values(&patches->entries);
}
