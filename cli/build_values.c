/* Values over faces and edges: the same everywhere, from a file, by formula or by group. */
#include "base/memory.h"
#include "cli/build.h"
#include "io/table.h"
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

/* Evaluates the formula over elements of `corners` vertices each, `width` numbers per element. */
static bool from_formula(const Build *b, Key at, Formula *formula, const int *vertices, int corners,
                         int count, int width, double *values)
{
    Error err;
    bool ok = formula != NULL;
    for (int e = 0; ok && e < count; e++) {
        double x[3], variables[BUILD_VARIABLES];
        middle(b->mesh, vertices + e * corners, corners, x);
        build_position(variables, x, 0);
        ok = formula_eval(formula, variables, values + e * width, &err) ||
             yaml_refuse(b->file, at.text, "%s", err.text);
    }
    formula_destroy(formula);
    return ok;
}

static bool from_table(const Build *b, Key at, const char *path, int width, double *values)
{
    Table table = {0};
    Error err;
    bool ok = table_read(path, width == 1 ? "value" : "x, y, z", &table, &err) ||
              yaml_refuse(b->file, at.text, "%s", err.text);
    if (ok && table.rows != b->mesh->face_count)
        ok =
            yaml_refuse(b->file, at.text, "%s has %d rows, and the mesh %d faces: one row per face is needed",
                        path, table.rows, b->mesh->face_count);
    if (ok) memcpy(values, table.values, (size_t)table.rows * (size_t)width * sizeof *values);
    table_clear(&table);
    return ok;
}

static const MeshGroup *find_group(const Build *b, Key at, const char *name, int dim, const char *needed)
{
    const MeshGroup *group = mesh_group(b->mesh, name);
    if (group && group->dim == dim) return group;
    if (group)
        yaml_refuse(b->file, at.text, "the group '%s' has no %s", name, needed);
    else
        yaml_refuse(b->file, at.text, "the mesh has no group '%s'", name);
    return NULL;
}

/* After the groups: NAN is left where an element is in none and there is no `other`. */
static bool check_covered(const Build *b, Key at, const double *values, int count, int width,
                          const char *element)
{
    int missing = 0;
    for (int e = 0; e < count; e++) missing += isnan(values[e * width]) ? 1 : 0;
    if (!missing) return true;
    return yaml_refuse(b->file, at.text, "%d %s in no group listed here: give `other`, the value elsewhere",
                       missing, element);
}

/* A range check for numbers that come from files and formulas; the table checks those in the scene. */
static bool check_range(const Build *b, Key at, const double *values, int count, bool zero_allowed)
{
    for (int e = 0; e < count; e++)
        if (!(values[e] > 0 || (zero_allowed && values[e] == 0)))
            return yaml_refuse(b->file, at.text, "the value of number %d is %g; it must be %s 0", e,
                               values[e], zero_allowed ? "at least" : "more than");
    return true;
}

bool build_face_numbers(const Build *b, Key at, const NumberScene *scene, double *values)
{
    int count = b->mesh->face_count;
    for (int f = 0; f < count; f++) values[f] = scene->groups_count ? scene->other : scene->value;
    bool ok = true;
    if (scene->file) ok = from_table(b, key("%s.file", at.text), scene->file, 1, values);
    if (scene->formula) {
        at = key("%s.formula", at.text);
        Formula *formula =
            build_formula(b, at, &scene->formula, 1, scene->where, scene->where_count, build_variables);
        ok = from_formula(b, at, formula, b->mesh->faces[0], 3, count, 1, values);
    }
    for (int g = 0; ok && g < scene->groups_count; g++) {
        const MeshGroup *group = find_group(b, key("%s.groups.%s", at.text, scene->groups[g].group),
                                            scene->groups[g].group, 2, "faces");
        ok = group != NULL;
        for (int k = 0; ok && k < group->count; k++) values[group->members[k]] = scene->groups[g].value;
    }
    return ok && check_covered(b, at, values, count, 1, "faces are") &&
           check_range(b, at, values, count, false);
}

/* Rows v0, v1, value; vertices in the file's numbers. */
static bool fold_table(const Build *b, Key at, const char *path, double *values)
{
    Table table = {0};
    Error err;
    bool ok =
        table_read(path, "v0, v1, value", &table, &err) || yaml_refuse(b->file, at.text, "%s", err.text);
    for (int e = 0; e < b->mesh->edge_count; e++) values[e] = 1;
    for (int row = 0; ok && row < table.rows; row++) {
        const double *line = table.values + 3 * row;
        int v[2] = {-1, -1};
        for (int i = 0; ok && i < 2; i++) {
            ok = line[i] == floor(line[i]) && fabs(line[i]) < 1e9;
            if (!ok)
                yaml_refuse(b->file, at.text, "%s:%d: %g is no vertex", path, table.line[row], line[i]);
            else if (!(ok = mesh_vertex(b->mesh, (int)line[i], &v[i], &err)))
                yaml_refuse(b->file, at.text, "%s:%d: %s", path, table.line[row], err.text);
        }
        int edge = ok ? mesh_edge(b->mesh, v[0], v[1]) : -1;
        if (ok && edge < 0)
            ok = yaml_refuse(b->file, at.text, "%s:%d: vertices %g and %g share no edge", path,
                             table.line[row], line[0], line[1]);
        if (ok) values[edge] = line[2];
    }
    table_clear(&table);
    return ok;
}

bool build_edge_numbers(const Build *b, Key at, const NumberScene *scene, double *values)
{
    int count = b->mesh->edge_count;
    for (int e = 0; e < count; e++) values[e] = scene->groups_count ? scene->other : scene->value;
    bool ok = true;
    if (scene->file) ok = fold_table(b, key("%s.file", at.text), scene->file, values);
    if (scene->formula) {
        at = key("%s.formula", at.text);
        Formula *formula =
            build_formula(b, at, &scene->formula, 1, scene->where, scene->where_count, build_variables);
        ok = from_formula(b, at, formula, b->mesh->edges[0], 2, count, 1, values);
    }
    for (int g = 0; ok && g < scene->groups_count; g++) {
        Key at_group = key("%s.groups.%s", at.text, scene->groups[g].group);
        const MeshGroup *group = find_group(b, at_group, scene->groups[g].group, 1, "edges");
        ok = group != NULL;
        for (int k = 0; ok && k < group->count; k++) {
            int edge = mesh_edge(b->mesh, group->members[2 * k], group->members[2 * k + 1]);
            if (edge >= 0) values[edge] = scene->groups[g].value;
        }
    }
    return ok && check_covered(b, at, values, count, 1, "edges are") &&
           check_range(b, at, values, count, true);
}

bool build_face_vectors(const Build *b, Key at, const VectorScene *scene, double *values)
{
    int count = b->mesh->face_count;
    for (int i = 0; i < 3 * count; i++)
        values[i] = scene->groups_count ? scene->other[i % 3] : scene->value[i % 3];
    for (int i = 0; scene->groups_count && i < 3 * count; i++)
        if (isnan(scene->other[0])) values[i] = NAN;
    bool ok = true;
    if (scene->file) ok = from_table(b, key("%s.file", at.text), scene->file, 3, values);
    if (scene->formula) {
        at = key("%s.formula", at.text);
        Formula *formula =
            build_formula(b, at, scene->formula, 3, scene->where, scene->where_count, build_variables);
        ok = from_formula(b, at, formula, b->mesh->faces[0], 3, count, 3, values);
    }
    for (int g = 0; ok && g < scene->groups_count; g++) {
        const MeshGroup *group = find_group(b, key("%s.groups.%s", at.text, scene->groups[g].group),
                                            scene->groups[g].group, 2, "faces");
        ok = group != NULL;
        for (int k = 0; ok && k < group->count; k++)
            memcpy(values + 3 * group->members[k], scene->groups[g].value, sizeof scene->groups[g].value);
    }
    return ok && check_covered(b, at, values, count, 3, "faces are");
}
