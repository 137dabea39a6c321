#include "export/parts.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "export/hull.h"
#include "export/mesh.h"
#include "export/zip.h"
#include "io/mark.h"
#include "io/text.h"
#include <math.h>
#include <string.h>

static const Color plain = {0.75, 0.75, 0.77, 1};

/* The elements that parts are made of, faces of a shell or tetrahedra, and of which part each is. */
typedef struct Sorting {
    const MeshFile *mesh;
    Parts *parts;
    int count;
    int *part; /* [count] -1: of none yet; owned */
} Sorting;

static int begin_part(Parts *parts, char *name, Color color)
{
    size_t count = (size_t)parts->count++;
    parts->list = mem_resize(parts->list, count, count + 1, sizeof *parts->list);
    parts->list[count] = (Part){.name = name, .color = color};
    return (int)count;
}

/* ---- Groups ---- */

/* The smallest one that has no part yet. */
static const MeshGroup *next_group(const MeshFile *mesh, int dim, const bool *done)
{
    const MeshGroup *next = NULL;
    for (int g = 0; g < mesh->group_count; g++) {
        const MeshGroup *group = &mesh->groups[g];
        if (group->dim == dim && !done[g] && (!next || group->count < next->count)) next = group;
    }
    return next;
}

static void take_rest(Sorting *sorting, const char *name)
{
    int rest = -1;
    for (int e = 0; e < sorting->count; e++) {
        if (sorting->part[e] >= 0) continue;
        if (rest < 0) rest = begin_part(sorting->parts, mem_text(name), plain);
        sorting->part[e] = rest;
    }
}

static bool by_groups(Sorting *sorting, Error *err)
{
    const MeshFile *mesh = sorting->mesh;
    int dim = mesh->cell_count ? 3 : 2;
    const MeshGroup *group;
    bool *done = mem_alloc((size_t)mesh->group_count, sizeof *done), any = false;
    while ((group = next_group(mesh, dim, done))) {
        int part = -1;
        done[group - mesh->groups] = any = true;
        for (int k = 0; k < group->count; k++) {
            int *of = &sorting->part[group->members[k]];
            if (*of >= 0) continue;
            if (part < 0)
                part =
                    begin_part(sorting->parts, mem_text(group->name), colormap_series(sorting->parts->count));
            *of = part;
        }
    }
    mem_free(done);
    take_rest(sorting, dim == 3 ? "(other tetrahedra)" : "(other faces)");
    return any || error_set(err, "the body's mesh has no groups of %s", dim == 3 ? "tetrahedra" : "faces");
}

/* ---- Levels ---- */

/* NaN where nothing is magnetised. */
static double magnetization_at(const double (*M)[3], int element)
{
    double length = vec3_length(vec3_load(M[element]));
    return length > 0 ? length : NAN;
}

/* Of so many equal steps from low to high. */
static int level_at(double value, double low, double high, int levels)
{
    double part = high > low * (1 + 1e-9) ? (value - low) / (high - low) : 0;
    return part < 1 ? (int)(levels * part) : levels - 1;
}

/* "1.2e+04 to 2e+04 A/m", or "2e+04 A/m". */
static char *level_name(double low, double high)
{
    return high > low * (1 + 1e-9) ? mem_format("%.4g to %.4g A/m", low, high) : mem_format("%.4g A/m", low);
}

/* One after the other, so that parts are in their order and none is empty. */
static void take_level(Sorting *sorting, const double (*M)[3], double low, double high, int level, int levels)
{
    double least = INFINITY, most = 0;
    int part = -1;
    for (int e = 0; e < sorting->count; e++) {
        double value = magnetization_at(M, e);
        if (isnan(value) || level_at(value, low, high, levels) != level) continue;
        Color color = colormap_color(COLORMAP_VIRIDIS, levels > 1 ? (double)level / (levels - 1) : 1);
        if (part < 0) part = begin_part(sorting->parts, NULL, color);
        sorting->part[e] = part;
        least = fmin(least, value), most = fmax(most, value);
    }
    if (part >= 0) sorting->parts->list[part].name = level_name(least, most);
}

static int frame_of(const PartsDef *def)
{
    return def->frame < 0 ? MESH_REST : def->frame;
}

static bool by_levels(Sorting *sorting, Result *result, const PartsDef *def, Error *err)
{
    Array array;
    int levels = def->levels;
    if (!export_magnetization_read(result, frame_of(def), sorting->mesh, &array, err)) return false;
    const double(*M)[3] = (const double(*)[3])array.data;
    double low = INFINITY, high = 0;
    for (int e = 0; e < sorting->count; e++) {
        double value = magnetization_at(M, e);
        if (value > 0) low = fmin(low, value), high = fmax(high, value);
    }
    for (int level = 0; high > 0 && level < levels; level++) take_level(sorting, M, low, high, level, levels);
    take_rest(sorting, "not magnetised");
    array_clear(&array);
    return high > 0 || error_set(err, sorting->mesh->cell_count
                                          ? "no tetrahedron is magnetised, and its skin has no volume"
                                          : "nothing is magnetised");
}

/* ---- All of it ---- */

static bool sort(Sorting *sorting, Result *result, const PartsDef *def, Error *err)
{
    if (def->groups) return by_groups(sorting, err);
    if (def->levels) return by_levels(sorting, result, def, err);
    take_rest(sorting, "body");
    return true;
}

bool parts_make(Result *result, const PartsDef *def, Parts *parts, Error *err)
{
    MeshFile mesh;
    Array thickness = {0};
    *parts = (Parts){0};
    bool ok = export_mesh_read(result, frame_of(def), &mesh, err) &&
              export_thickness_read(result, frame_of(def), &mesh, &thickness, err);
    if (ok && !mesh.cell_count && !thickness.data)
        ok = result_check_state(result, err) &&
             error_set(err, "how thick the shell is, its result says when the run has finished");
    Sorting sorting = {
        .mesh = &mesh, .parts = parts, .count = mesh.cell_count ? mesh.cell_count : mesh.face_count};
    sorting.part = mem_alloc((size_t)sorting.count, sizeof *sorting.part);
    for (int e = 0; e < sorting.count; e++) sorting.part[e] = -1;
    ok = ok && sort(&sorting, result, def, err);
    if (ok) hull_make(&mesh, thickness.data, sorting.part, parts);
    mem_free(sorting.part);
    array_clear(&thickness);
    mesh_file_clear(&mesh);
    return ok;
}

void parts_clear(Parts *parts)
{
    for (int k = 0; k < parts->count; k++) {
        mem_free(parts->list[k].name);
        mem_free(parts->list[k].points);
        mem_free(parts->list[k].faces);
    }
    mem_free(parts->list);
    *parts = (Parts){0};
}

/* ---- STL ---- */

static void add_vector(Bytes *file, Vec3 v)
{
    bytes_add_float(file, v.x);
    bytes_add_float(file, v.y);
    bytes_add_float(file, v.z);
}

void parts_write_stl(const Part *part, Bytes *file)
{
    char header[80] = MARK_STL(SLENDER_VERSION); /* must not begin with "solid": that is the other format */
    bytes_add(file, header, sizeof header);
    bytes_add_u32(file, (uint32_t)part->face_count);
    for (int f = 0; f < part->face_count; f++) {
        Vec3 x[3];
        for (int i = 0; i < 3; i++) x[i] = vec3_scale(1e3, vec3_load(part->points[part->faces[f][i]]));
        Vec3 normal = vec3_cross(vec3_sub(x[1], x[0]), vec3_sub(x[2], x[0]));
        add_vector(file, vec3_length(normal) > 0 ? vec3_unit(normal) : normal);
        for (int i = 0; i < 3; i++) add_vector(file, x[i]);
        bytes_add_u16(file, 0);
    }
}

/* ---- 3MF: 3D Manufacturing Format, Core Specification 1.3 ---- */

static void add_part(Text *xml, const Part *part, int id, int material)
{
    text_add(xml, "<object id=\"%d\" type=\"model\" pid=\"1\" pindex=\"%d\" name=\"", id, material);
    text_add_xml(xml, part->name);
    text_add(xml, "\"><mesh>\n<vertices>\n");
    for (int p = 0; p < part->point_count; p++)
        text_add(xml, "<vertex x=\"%.9g\" y=\"%.9g\" z=\"%.9g\"/>\n", 1e3 * part->points[p][0],
                 1e3 * part->points[p][1], 1e3 * part->points[p][2]);
    text_add(xml, "</vertices>\n<triangles>\n");
    for (int f = 0; f < part->face_count; f++)
        text_add(xml, "<triangle v1=\"%d\" v2=\"%d\" v3=\"%d\"/>\n", part->faces[f][0], part->faces[f][1],
                 part->faces[f][2]);
    text_add(xml, "</triangles>\n</mesh></object>\n");
}

/* A material for each part, and one object of them all, so that they stay where they are to each other. */
static void add_model(Text *xml, const Parts *parts)
{
    enum { FIRST = 2 };
    text_add(xml,
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
             "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
             "<metadata name=\"Application\">slender %s</metadata>\n<resources>\n<basematerials id=\"1\">\n",
             SLENDER_VERSION);
    for (int k = 0; k < parts->count; k++) {
        Color color = parts->list[k].color;
        text_add(xml, "<base name=\"");
        text_add_xml(xml, parts->list[k].name);
        text_add(xml, "\" displaycolor=\"#%02X%02X%02XFF\"/>\n", (unsigned)lround(255 * color.r),
                 (unsigned)lround(255 * color.g), (unsigned)lround(255 * color.b));
    }
    text_add(xml, "</basematerials>\n");
    for (int k = 0; k < parts->count; k++) add_part(xml, &parts->list[k], FIRST + k, k);
    int all = FIRST + parts->count;
    text_add(xml, "<object id=\"%d\" type=\"model\" name=\"body\"><components>\n", all);
    for (int k = 0; k < parts->count; k++) text_add(xml, "<component objectid=\"%d\"/>\n", FIRST + k);
    text_add(xml, "</components></object>\n</resources>\n<build><item objectid=\"%d\"/></build>\n</model>\n",
             all);
}

static bool add_text(Zip *zip, const char *name, const char *text, Error *err)
{
    return zip_add(zip, name, text, strlen(text), err);
}

bool parts_write_3mf(const Parts *parts, Bytes *file, Error *err)
{
    static const char
        types[] = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                  "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
                  "<Default Extension=\"rels\" "
                  "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
                  "<Default Extension=\"model\" "
                  "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
                  "</Types>\n",
        relations[] =
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
            "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
            "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";
    Text xml = {0};
    Zip zip = {.file = file};
    add_model(&xml, parts);
    bool ok = add_text(&zip, "[Content_Types].xml", types, err) &&
              add_text(&zip, "_rels/.rels", relations, err) &&
              add_text(&zip, "3D/3dmodel.model", xml.text, err);
    zip_end(&zip);
    mem_free(xml.text);
    return ok;
}
