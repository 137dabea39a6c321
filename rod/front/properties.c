#include "rod/front/properties.h"
#include "rod/front/curves.h"
#include <math.h>

static const struct {
    const char *key, *columns;
} rows[ROD_ALONGS] = {
    [ROD_YOUNG] = {"rod.young", "s [m], young [Pa]"},
    [ROD_RADIUS] = {"rod.radius", "s [m], radius [m]"},
    [ROD_WIDTH] = {"rod.section.width", "s [m], width [m]"},
    [ROD_HEIGHT] = {"rod.section.height", "s [m], height [m]"},
    [ROD_AREA] = {"rod.section.area", "s [m], area [m^2]"},
    [ROD_I1] = {"rod.section.I1", "s [m], I1 [m^4]"},
    [ROD_I2] = {"rod.section.I2", "s [m], I2 [m^4]"},
    [ROD_J] = {"rod.section.J", "s [m], J [m^4]"},
};

static bool read_along(const Build *b, int k, RodAlong *along)
{
    static const char *const variables[] = {"s", "L", NULL};
    const AlongScene *from = along->from;
    if (from && from->formula) {
        along->formula = build_formula(b, key("%s.formula", rows[k].key), &from->formula, 1, from->where,
                                       from->where_count, variables);
        return along->formula != NULL;
    }
    return !from || !from->file ||
           rod_table_open(b, key("%s.file", rows[k].key).text, from->file, rows[k].columns, &along->table);
}

bool rod_properties_read(const RodScene *scene, const Build *b, RodProperties *properties)
{
    const SectionScene *own = scene->section;
    const AlongScene *const from[ROD_ALONGS] = {
        scene->young,           scene->radius,        own ? own->width : NULL, own ? own->height : NULL,
        own ? own->area : NULL, own ? own->I1 : NULL, own ? own->I2 : NULL,    own ? own->J : NULL};
    bool ok = true;
    *properties = (RodProperties){.scene = scene};
    for (int k = ROD_ALONGS - 1; k >= 0; k--) {
        properties->along[k].from = from[k];
        ok = read_along(b, k, &properties->along[k]) && ok;
        if (!from[k] || (!from[k]->formula && !from[k]->file)) continue;
        properties->varies = rows[k].key;
        if (k != ROD_YOUNG) properties->section_varies = rows[k].key;
    }
    if (own && own->width && !own->height)
        ok = yaml_refuse(b->file, "rod.section",
                         "a rectangle needs `width`, along n1, and `height`, along n2");
    if (own && own->area && !(own->I1 && own->I2 && own->J))
        ok = yaml_refuse(
            b->file, "rod.section",
            "beside `area` it needs `I1` and `I2`, for bending about n1 and n2, and `J`, of torsion");
    return ok;
}

void rod_properties_clear(RodProperties *properties)
{
    for (int k = 0; k < ROD_ALONGS; k++) {
        formula_destroy(properties->along[k].formula);
        table_clear(&properties->along[k].table);
    }
}

/* Linear between its rows, constant beyond them: so are all values above 0 where these are. */
static bool check_rows(const Build *b, Key at, const RodAlong *along)
{
    const Table *table = &along->table;
    for (int row = 0; row < table->rows; row++)
        if (!(table->values[2 * row + 1] > 0))
            return yaml_refuse(b->file, at.text, "%s:%d: the value is %g; it must be more than 0",
                               along->from->file, table->line[row], table->values[2 * row + 1]);
    return true;
}

bool rod_properties_check(const RodProperties *properties, const Build *b, double length)
{
    bool ok = true;
    for (int k = 0; k < ROD_ALONGS; k++) {
        const RodAlong *along = &properties->along[k];
        Key at = key("%s.file", rows[k].key);
        if (along->table.rows)
            ok = rod_table_check(b, at.text, along->from->file, length, &along->table) &&
                 check_rows(b, at, along) && ok;
    }
    return ok;
}

static bool value_at(const RodAlong *along, const Build *b, const char *at, double s, double L, double *value)
{
    Error err;
    double place[] = {s, L};
    *value = along->from ? along->from->value : NAN;
    if (along->formula && !formula_eval(along->formula, place, value, &err))
        return yaml_refuse(b->file, at, "%s", err.text);
    if (along->table.rows) rod_table_at(&along->table, s, value);
    return !(*value <= 0) ||
           yaml_refuse(b->file, at, "it is %g at s = %g m, and must be above 0 all along", *value, s);
}

/* By the numbers of its outline, or by all that it amounts to. */
static RodSection own_section(const SectionScene *own, const double *v, double poisson, double density)
{
    RodSectionDef def = {.area = v[ROD_AREA],
                         .I1 = v[ROD_I1],
                         .I2 = v[ROD_I2],
                         .J = v[ROD_J],
                         .reach = sqrt(v[ROD_AREA] / M_PI)};
    if (!isnan(own->kappa[0])) def.kappa1 = own->kappa[0], def.kappa2 = own->kappa[1];
    RodSection unit = own->width ? rod_rectangle(v[ROD_WIDTH], v[ROD_HEIGHT], 1, poisson, density)
                                 : rod_given(&def, 1, poisson, density);
    if (!isnan(own->contact_radius)) unit.reach = own->contact_radius;
    return unit;
}

bool rod_properties_at(const RodProperties *properties, const Build *b, double s, double L, RodSection *unit,
                       double *young)
{
    const RodScene *scene = properties->scene;
    double v[ROD_ALONGS], poisson = isnan(scene->poisson) ? 0.5 : scene->poisson;
    for (int k = 0; k < ROD_ALONGS; k++)
        if (!value_at(&properties->along[k], b, rows[k].key, s, L, &v[k])) return false;
    const double *a = scene->ellipse;
    *unit = scene->section ? own_section(scene->section, v, poisson, scene->density)
            : a            ? rod_ellipse(a[0], a[1], 1, poisson, scene->density)
                           : rod_circle(v[ROD_RADIUS], 1, poisson, scene->density);
    *young = v[ROD_YOUNG];
    return true;
}

/* From (1, -1) on around the square of half-width 1, or the circle that it is round. */
static void corner_of(bool round, int i, double at[2])
{
    static const double corners[5][2] = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    int side = i / ROD_OUTLINE_SIDE;
    double part = (double)(i % ROD_OUTLINE_SIDE) / ROD_OUTLINE_SIDE, angle = 2 * M_PI * i / ROD_OUTLINE;
    for (int k = 0; k < 2; k++)
        at[k] = round ? (k ? sin(angle) : cos(angle))
                      : corners[side][k] + part * (corners[side + 1][k] - corners[side][k]);
}

void rod_properties_outline(const RodProperties *properties, const Build *b, double L, double reach,
                            double (*outline)[2])
{
    const RodScene *scene = properties->scene;
    const SectionScene *own = scene->section;
    double half[2] = {reach, reach};
    bool flat = own && own->width;
    if (scene->ellipse) half[0] = scene->ellipse[0], half[1] = scene->ellipse[1];
    for (int k = 0; flat && k < 2; k++)
        if (value_at(&properties->along[ROD_WIDTH + k], b, rows[ROD_WIDTH + k].key, 0, L, &half[k]))
            half[k] /= 2;
    for (int i = 0; i < ROD_OUTLINE; i++) {
        corner_of(!flat, i, outline[i]);
        for (int k = 0; k < 2; k++) outline[i][k] *= half[k];
    }
}
