/* XDMF 2 with data items of the form file:/path|start:stride:count:dims, which ParaView 5.11's readers
 * understand. */
#include "io/xdmf.h"
#include "base/memory.h"
#include "base/plain.h"
#include "io/text.h"
#include <string.h>

/* What is being written. */
typedef struct Sidecar {
    Text text;
    const char *result; /* the file's name without its folder */
    const char *real;   /* how positions and fields are stored */
    const VtkFrames *frames;
} Sidecar;

/* Some rows of a long array of rows: which file, path and part. */
static void add_item(Sidecar *sidecar, const char *path, int first, int count, int width, int total,
                     const char *type)
{
    Text *text = &sidecar->text;
    bool wide = width > 1;
    text_add(text, "<DataItem Dimensions=\"%d", count);
    if (wide) text_add(text, " %d", width);
    text_add(text, "\" %s Format=\"HDF\">", type);
    text_add_xml(text, sidecar->result);
    text_add(text, ":/");
    text_add_xml(text, path);
    text_add(text, "|");
    if (wide)
        text_add(text, "%d 0:1 1:%d %d:%d %d", first, count, width, total, width);
    else
        text_add(text, "%d:1:%d:%d", first, count, total);
    text_add(text, "</DataItem>\n");
}

/* An array of the frames: where its part for a step begins, as in /VTKHDF/Steps. */
typedef struct Field {
    const char *name;
    bool cell;
    int width, stored, count; /* rows of a step */
    int *first;               /* [step] */
} Field;

static bool make_field(const VtkFrames *frames, const char *name, Field *field, Error *err)
{
    *field = (Field){.name = strchr(name, '/') + 1, .cell = name[0] == 'c', .width = 1};
    field->count = field->cell ? frames->cells.count : frames->vertex_count;
    field->first = mem_alloc((size_t)frames->count, sizeof *field->first);
    for (int k = 0; k < frames->count; k++) {
        bool has;
        if (!journal_has(frames->journal, "frame", frames->frames[k], name, &has, err)) return false;
        field->stored += has;
        field->first[k] = (field->stored - 1) * field->count;
    }
    Array array;
    if (!journal_get(frames->journal, "frame", frames->frames[0], name, &array, err)) return false;
    if (array.rank > 1) field->width = array.dims[1];
    array_clear(&array);
    return true;
}

static void add_field(Sidecar *sidecar, const Field *field, int step)
{
    char *path = mem_format("VTKHDF/%s/%s", field->cell ? "CellData" : "PointData", field->name);
    text_add(&sidecar->text, "        <Attribute Name=\"");
    text_add_xml(&sidecar->text, field->name);
    text_add(&sidecar->text, "\" AttributeType=\"%s\" Center=\"%s\">",
             field->width == 3 ? "Vector" : "Scalar", field->cell ? "Cell" : "Node");
    add_item(sidecar, path, field->first[step], field->count, field->width, field->stored * field->count,
             sidecar->real);
    text_add(&sidecar->text, "        </Attribute>\n");
    mem_free(path);
}

/* Polylines of different lengths are listed with their types and lengths among the points. */
static void add_topology(Sidecar *sidecar)
{
    const VtkCells *cells = &sidecar->frames->cells;
    const char *type = cells->mixed ? "Mixed" : cells->lines ? "Polyline" : "Triangle";
    text_add(&sidecar->text, "        <Topology TopologyType=\"%s\" NumberOfElements=\"%d\"", type,
             cells->count);
    if (cells->lines && cells->uniform) text_add(&sidecar->text, " NodesPerElement=\"%d\"", cells->uniform);
    text_add(&sidecar->text, ">");
    int size = cells->mixed ? cells->mixed_count : cells->id_count;
    add_item(sidecar, cells->mixed ? "slender/xdmf_topology" : "VTKHDF/Connectivity", 0, size, 1, size,
             "NumberType=\"Int\" Precision=\"8\"");
    text_add(&sidecar->text, "        </Topology>\n");
}

static void add_step(Sidecar *sidecar, const Field *fields, int field_count, int step)
{
    const VtkFrames *frames = sidecar->frames;
    text_add(&sidecar->text,
             "      <Grid Name=\"%s\" GridType=\"Uniform\">\n        <Time Value=\"%.17g\"/>\n",
             frames->cells.lines ? "curves" : "shell", frames->times[step]);
    add_topology(sidecar);
    text_add(&sidecar->text, "        <Geometry GeometryType=\"XYZ\">");
    add_item(sidecar, "VTKHDF/Points", step * frames->vertex_count, frames->vertex_count, 3,
             frames->count * frames->vertex_count, sidecar->real);
    text_add(&sidecar->text, "        </Geometry>\n");
    for (int k = 0; k < field_count; k++) add_field(sidecar, &fields[k], step);
    text_add(&sidecar->text, "      </Grid>\n");
}

/* Readers cut "file:/path|part" at the first : and the first |, and take blanks from its ends. */
bool xdmf_can_name(const char *result)
{
    const char *slash = strrchr(result, '/'), *name = slash ? slash + 1 : result;
    size_t length = strlen(name);
    return length && plain_is(name) && !strpbrk(name, ":|") && name[0] != ' ' && name[length - 1] != ' ';
}

char *xdmf_text(const char *result, const VtkFrames *frames, Error *err)
{
    const char *slash = strrchr(result, '/');
    Sidecar sidecar = {.result = slash ? slash + 1 : result,
                       .real = frames->single ? "NumberType=\"Float\" Precision=\"4\""
                                              : "NumberType=\"Float\" Precision=\"8\"",
                       .frames = frames};
    Field *known = mem_alloc((size_t)frames->field_count, sizeof *known);
    int count = 0;
    bool ok = true;
    for (int k = 0; ok && k < frames->field_count; k++)
        if (!strncmp(frames->fields[k], "cell/", 5) || !strncmp(frames->fields[k], "point/", 6))
            ok = make_field(frames, frames->fields[k], &known[count++], err);
    text_add(&sidecar.text,
             "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n"
             "    <Grid Name=\"slender\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
    for (int step = 0; ok && step < frames->count; step++) add_step(&sidecar, known, count, step);
    text_add(&sidecar.text, "    </Grid>\n  </Domain>\n</Xdmf>\n");
    for (int k = 0; k < count; k++) mem_free(known[k].first);
    mem_free(known);
    if (ok) return sidecar.text.text;
    mem_free(sidecar.text.text);
    return NULL;
}
