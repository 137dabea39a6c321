/* Values over cells, faces and edges: the same everywhere, from a file, by formula or by group. */
#include "base/memory.h"
#include "base/plain.h"
#include "io/table.h"
#include "model/build.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *const build_variables[] = {"x", "y", "z", "r", NULL};
const char *const build_variables_time[] = {"x", "y", "z", "r", "t", NULL};

Key key(const char *format, ...)
{
    Key k;
    va_list args;
    va_start(args, format);
    vsnprintf(k.text, sizeof k.text, format, args);
    va_end(args);
    return k;
}

void build_position(double *variables, const double *x, double time)
{
    memcpy(variables, x, 3 * sizeof *x);
    variables[3] = hypot(x[0], x[1]);
    variables[4] = time;
}

bool build_check_name(const Build *b, Key at, const char *whose, const char *name)
{
    enum { NAME_MAX_BYTES = 250 };
    bool good =
        *name && plain_is(name) && !strchr(name, '/') && strlen(name) <= NAME_MAX_BYTES && strcmp(name, ".");
    return good || yaml_refuse(b->file, at.text,
                               "%s's name is a word without '/' or control characters, of at most %d bytes, "
                               "and not '.'",
                               whose, NAME_MAX_BYTES);
}

Formula *build_formula(const Build *b, Key at, char *const *formula, int count, const WhereScene *where,
                       int where_count, const char *const *variables)
{
    FormulaHelper *helpers = mem_alloc((size_t)where_count, sizeof *helpers);
    for (int k = 0; k < where_count; k++) helpers[k] = (FormulaHelper){where[k].name, where[k].formula};
    Error err;
    Formula *result =
        formula_create((const char *const *)formula, count, helpers, where_count, variables, &err);
    if (!result) yaml_refuse(b->file, at.text, "%s", err.text);
    mem_free(helpers);
    return result;
}

/* Where a formula of a face or an edge is evaluated at rest. */
static void middle(const Mesh *mesh, const int *vertices, int count, double *x)
{
    for (int i = 0; i < 3; i++) {
        x[i] = 0;
        for (int k = 0; k < count; k++) x[i] += mesh->rest[vertices[k]][i] / count;
    }
}

/* The mesh's edges (dim 1), faces or cells: `corners` vertices each, in rows of `each`. */
typedef struct Elements {
    const int *vertices;
    int dim, corners, each, count;
} Elements;

static const char *const element_names[] = {"vertex", "edge", "face", "tetrahedron"};
const char *const build_elements[] = {"vertices", "edges", "faces", "tetrahedra"};

static Elements elements_of(const Mesh *mesh, int dim)
{
    if (dim == 1) return (Elements){mesh->edges[0], 1, 2, 2, mesh->edge_count};
    if (dim == 2) return (Elements){mesh->faces[0], 2, 3, 3, mesh->face_count};
    return (Elements){mesh->cells, 3, 4, mesh->cell_nodes, mesh->cell_count};
}

/* `width` numbers per element; the key is the formula's. */
static bool from_formula(const Build *b, Key at, char *const *formula, int width, const WhereScene *where,
                         int where_count, Elements elements, double *values)
{
    Formula *made = build_formula(b, at, formula, width, where, where_count, build_variables);
    Error err;
    bool ok = made != NULL;
    for (int e = 0; ok && e < elements.count; e++) {
        double x[3], variables[BUILD_VARIABLES];
        middle(b->mesh, elements.vertices + e * elements.each, elements.corners, x);
        build_position(variables, x, 0);
        ok = formula_eval(made, variables, values + e * width, &err) ||
             yaml_refuse(b->file, at.text, "%s", err.text);
    }
    formula_destroy(made);
    return ok;
}

bool build_vectors_at(const Build *b, Key at, char *const *formula, const WhereScene *where, int where_count,
                      const double *place, int count, double *values)
{
    Formula *made = build_formula(b, at, formula, 3, where, where_count, build_variables);
    bool ok = made != NULL;
    Error err;
    for (int k = 0; ok && k < count; k++) {
        double variables[BUILD_VARIABLES];
        build_position(variables, place + 3 * k, 0);
        ok = formula_eval(made, variables, values + 3 * k, &err) ||
             yaml_refuse(b->file, at.text, "%s", err.text);
    }
    formula_destroy(made);
    return ok;
}

/* A row of a table; the scene's own numbers have been checked. */
static bool check_row(const Build *b, Key at, const char *path, const Table *table, int row, double value,
                      bool zero_allowed)
{
    return value > 0 || (zero_allowed && value == 0) ||
           yaml_refuse(b->file, at.text, "%s:%d: the value is %g; it must be %s 0", path, table->line[row],
                       value, zero_allowed ? "at least" : "more than");
}

static bool from_table(const Build *b, Key at, const char *path, const char *columns, int width,
                       Elements elements, double *values)
{
    Table table = {0};
    Error err;
    bool ok = table_read(path, columns, &table, &err) || yaml_refuse(b->file, at.text, "%s", err.text);
    if (ok && table.rows != elements.count)
        ok = yaml_refuse(b->file, at.text, "%s has %d rows, and the mesh %d %s: one row per %s is needed",
                         path, table.rows, elements.count, build_elements[elements.dim],
                         element_names[elements.dim]);
    for (int row = 0; ok && width == 1 && row < table.rows; row++)
        ok = check_row(b, at, path, &table, row, table.values[row], false);
    if (ok) memcpy(values, table.values, (size_t)table.rows * (size_t)width * sizeof *values);
    table_clear(&table);
    return ok;
}

const MeshGroup *build_group(const Build *b, Key at, const char *name, int dim)
{
    const MeshGroup *group = mesh_group(b->mesh, name, dim);
    if (group) return group;
    bool other = false;
    for (int d = 0; d <= 3; d++) other |= mesh_group(b->mesh, name, d) != NULL;
    char *names = mesh_group_names(b->mesh, dim);
    if (other)
        yaml_refuse(b->file, at.text, "the group '%s' has no %s; groups of %s: %s", name, build_elements[dim],
                    build_elements[dim], names);
    else
        yaml_refuse(b->file, at.text, "the mesh has no group '%s'; groups of %s: %s", name,
                    build_elements[dim], names);
    mem_free(names);
    return NULL;
}

/* ---- Groups ---- */

/* What stands in a scene under `groups`: entries of this size that begin with a group's name, and the values
 * behind it. */
typedef struct GroupList {
    const void *entries;
    size_t size;
    int count, dim;
} GroupList;

static const char *group_name(const GroupList *list, int k)
{
    return *(char *const *)((const char *)list->entries + (size_t)k * list->size);
}

static bool same_value(const GroupList *list, int k, int other)
{
    const char *entries = list->entries, *a = entries + (size_t)k * list->size,
               *b = entries + (size_t)other * list->size;
    return !memcmp(a + sizeof(char *), b + sizeof(char *), list->size - sizeof(char *));
}

int build_element(const Build *b, Key at, const MeshGroup *group, int member)
{
    if (group->dim >= 2) return group->members[member];
    const Mesh *mesh = b->mesh;
    int v = group->members[2 * member], w = group->members[2 * member + 1], edge = mesh_edge(mesh, v, w);
    if (edge < 0)
        yaml_refuse(b->file, at.text, "the line from vertex %d to %d of the group is no edge of the mesh",
                    mesh->file_vertex[v], mesh->file_vertex[w]);
    return edge;
}

/* Gives a group what belongs to it and to no smaller one; sizes[k] is the size of group k. */
static bool take_elements(const Build *b, Key at, const GroupList *list, int k, const MeshGroup *group,
                          int *sizes, int *owner)
{
    sizes[k] = group->count;
    for (int m = 0; m < group->count; m++) {
        int e = build_element(b, at, group, m), other = e < 0 ? -1 : owner[e];
        if (e < 0) return false;
        if (other >= 0 && sizes[other] == group->count && !same_value(list, k, other))
            return yaml_refuse(
                b->file, at.text,
                "the groups '%s' and '%s' share %s %d and are as large as one another: which value it "
                "has cannot be told",
                group->name, group_name(list, other), element_names[group->dim], e);
        if (other < 0 || group->count < sizes[other]) owner[e] = k;
    }
    return true;
}

/* owner[element]: the entry whose value it has, -1: none. What lies in several groups belongs to the smallest
 * one, so that the order of the entries means nothing. */
static bool assign_groups(const Build *b, Key at, const GroupList *list, int element_count, int *owner)
{
    int *sizes = mem_alloc((size_t)list->count, sizeof *sizes);
    bool ok = true;
    for (int e = 0; e < element_count; e++) owner[e] = -1;
    for (int k = 0; ok && k < list->count; k++) {
        Key here = key("%s.groups.%s", at.text, group_name(list, k));
        const MeshGroup *group = build_group(b, here, group_name(list, k), list->dim);
        ok = group && take_elements(b, here, list, k, group, sizes, owner);
    }
    mem_free(sizes);
    return ok;
}

static bool put_numbers(const Build *b, Key at, const NumberScene *scene, Elements elements, double *values)
{
    GroupList list = {scene->groups, sizeof *scene->groups, scene->groups_count, elements.dim};
    int *owner = mem_alloc((size_t)elements.count, sizeof *owner);
    bool ok = assign_groups(b, at, &list, elements.count, owner);
    for (int e = 0; e < elements.count; e++)
        if (owner[e] >= 0) values[e] = scene->groups[owner[e]].value;
    mem_free(owner);
    return ok;
}

void build_magnetization(const double value[3], const double remanence[3], double to[3])
{
    for (int i = 0; i < 3; i++) to[i] = isnan(remanence[0]) ? value[i] : remanence[i] / FLUX_MU_0;
}

static bool put_vectors(const Build *b, Key at, const VectorScene *scene, Elements elements, double *values)
{
    GroupList list = {scene->groups, sizeof *scene->groups, scene->groups_count, elements.dim};
    int *owner = mem_alloc((size_t)elements.count, sizeof *owner);
    bool ok = assign_groups(b, at, &list, elements.count, owner);
    for (int f = 0; f < elements.count; f++)
        if (owner[f] >= 0) {
            const VectorGroup *group = &scene->groups[owner[f]];
            build_magnetization(group->value, group->remanence, values + 3 * f);
        }
    mem_free(owner);
    return ok;
}

/* After the groups: NAN is left where an element is in none and there is no `other`. */
static bool check_covered(const Build *b, Key at, const double *values, Elements elements, int width)
{
    int missing = 0;
    for (int e = 0; e < elements.count; e++) missing += isnan(values[e * width]) ? 1 : 0;
    if (!missing) return true;
    return yaml_refuse(b->file, at.text,
                       "%d %s %s in no group listed here: give `other`, the value elsewhere", missing,
                       missing == 1 ? element_names[elements.dim] : build_elements[elements.dim],
                       missing == 1 ? "is" : "are");
}

/* What a formula makes of them; a table's rows are checked as they are read, the scene's own numbers by its table. */
static bool check_range(const Build *b, Key at, const double *values, Elements elements)
{
    bool zero_allowed = elements.dim == 1;
    for (int e = 0; e < elements.count; e++) {
        if (values[e] > 0 || (zero_allowed && values[e] == 0)) continue;
        double x[3];
        middle(b->mesh, elements.vertices + e * elements.each, elements.corners, x);
        return yaml_refuse(b->file, at.text, "at (%.4g, %.4g, %.4g) m, in %s %d, it is %g; it must be %s 0",
                           x[0], x[1], x[2], element_names[elements.dim], e, values[e],
                           zero_allowed ? "at least" : "more than");
    }
    return true;
}

/* The edge that a row names by its vertices, in the file's numbers; -1 after a refusal. */
static int fold_edge(const Build *b, Key at, const char *path, const Table *table, int row)
{
    const double *line = table->values + 3 * row;
    int v[2] = {-1, -1}, edge = -1;
    Error err;
    bool ok = true;
    for (int i = 0; ok && i < 2; i++) {
        ok = line[i] == floor(line[i]) && fabs(line[i]) < 1e9;
        if (!ok)
            yaml_refuse(b->file, at.text, "%s:%d: %g is no vertex", path, table->line[row], line[i]);
        else if (!(ok = mesh_vertex(b->mesh, (int)line[i], &v[i], &err)))
            yaml_refuse(b->file, at.text, "%s:%d: %s", path, table->line[row], err.text);
    }
    if (ok && (edge = mesh_edge(b->mesh, v[0], v[1])) < 0)
        yaml_refuse(b->file, at.text, "%s:%d: vertices %g and %g share no edge", path, table->line[row],
                    line[0], line[1]);
    return edge;
}

/* Rows v0, v1, value. */
static bool fold_table(const Build *b, Key at, const char *path, double *values)
{
    Table table = {0};
    Error err;
    int *owner = mem_alloc((size_t)b->mesh->edge_count, sizeof *owner); /* the edge's line; 0: none */
    bool ok =
        table_read(path, "v0, v1, value", &table, &err) || yaml_refuse(b->file, at.text, "%s", err.text);
    for (int e = 0; e < b->mesh->edge_count; e++) values[e] = 1;
    for (int row = 0; ok && row < table.rows; row++) {
        int edge = fold_edge(b, at, path, &table, row);
        double value = table.values[3 * row + 2];
        ok = edge >= 0 && check_row(b, at, path, &table, row, value, true);
        if (ok && owner[edge] && values[edge] != value)
            ok = yaml_refuse(b->file, at.text,
                             "%s:%d: the edge of vertices %g and %g is %g here and %g in line %d", path,
                             table.line[row], table.values[3 * row], table.values[3 * row + 1], value,
                             values[edge], owner[edge]);
        if (ok) values[edge] = value, owner[edge] = table.line[row];
    }
    mem_free(owner);
    table_clear(&table);
    return ok;
}

bool build_numbers(const Build *b, Key at, int dim, const char *unit, const NumberScene *scene,
                   double *values)
{
    Elements elements = elements_of(b->mesh, dim);
    for (int e = 0; e < elements.count; e++) values[e] = scene->groups_count ? scene->other : scene->value;
    bool ok = true;
    if (scene->file && elements.dim == 1) ok = fold_table(b, key("%s.file", at.text), scene->file, values);
    if (scene->file && elements.dim != 1)
        ok = from_table(b, key("%s.file", at.text), scene->file, key("value [%s]", unit).text, 1, elements,
                        values);
    if (scene->formula) {
        at = key("%s.formula", at.text);
        ok = from_formula(b, at, &scene->formula, 1, scene->where, scene->where_count, elements, values) &&
             check_range(b, at, values, elements);
    }
    return ok && put_numbers(b, at, scene, elements, values) && check_covered(b, at, values, elements, 1);
}

bool build_vectors(const Build *b, Key at, int dim, const VectorScene *scene, double *values)
{
    Elements elements = elements_of(b->mesh, dim);
    int count = elements.count;
    for (int e = 0; e < count && !scene->groups_count; e++)
        build_magnetization(scene->value, scene->remanence, values + 3 * e);
    for (int i = 0; i < 3 * count && scene->groups_count; i++) values[i] = scene->other[i % 3];
    for (int i = 0; scene->groups_count && i < 3 * count; i++)
        if (isnan(scene->other[0])) values[i] = NAN;
    bool ok = true;
    if (scene->file)
        ok = from_table(b, key("%s.file", at.text), scene->file, "x [A/m], y [A/m], z [A/m]", 3, elements,
                        values);
    if (scene->formula) {
        at = key("%s.formula", at.text);
        ok = from_formula(b, at, scene->formula, 3, scene->where, scene->where_count, elements, values);
    }
    return ok && put_vectors(b, at, scene, elements, values) && check_covered(b, at, values, elements, 3);
}
