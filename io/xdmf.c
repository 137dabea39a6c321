/* XDMF 2 with data items of the form file:/path|start:stride:count:dims, which ParaView 5.11's readers
 * understand. */
#include "io/xdmf.h"
#include "base/memory.h"
#include "io/text.h"
#include <string.h>

/* One row of a long array of rows: which file, path and part. */
static void add_item(Text *text, const XdmfDef *def, const char *path, int first, int count, int width,
                     int total, const char *type)
{
    const char *slash = strrchr(def->result, '/'), *name = slash ? slash + 1 : def->result;
    bool wide = width > 1;
    text_add(text, "<DataItem Dimensions=\"%d", count);
    if (wide) text_add(text, " %d", width);
    text_add(text, "\" %s Format=\"HDF\">%s:/VTKHDF/%s|", type, name, path);
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
    int width, stored, rows; /* rows in all */
    int *first;              /* [step] */
} Field;

static Field make_field(const XdmfDef *def, const char *name, Journal *journal, const int *frames)
{
    Field field = {.name = strchr(name, '/') + 1, .cell = name[0] == 'c', .width = 1};
    int count = field.cell ? def->face_count : def->vertex_count;
    field.first = mem_alloc((size_t)def->step_count, sizeof *field.first);
    for (int k = 0; k < def->step_count; k++) {
        field.stored += k == 0 || journal_has(journal, "frame", frames[k], name);
        field.first[k] = (field.stored - 1) * count;
    }
    field.rows = field.stored * count;
    Array array;
    if (journal_get(journal, "frame", frames[0], name, &array, NULL)) {
        if (array.rank > 1) field.width = array.dims[1];
        array_clear(&array);
    }
    return field;
}

static void add_field(Text *text, const XdmfDef *def, const Field *field, int step, const char *type)
{
    char *path = mem_format("%s/%s", field->cell ? "CellData" : "PointData", field->name);
    text_add(text, "        <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">", field->name,
             field->width == 3 ? "Vector" : "Scalar", field->cell ? "Cell" : "Node");
    add_item(text, def, path, field->first[step], field->cell ? def->face_count : def->vertex_count,
             field->width, field->rows, type);
    text_add(text, "        </Attribute>\n");
    mem_free(path);
}

char *xdmf_text(const XdmfDef *def, char *const *fields, int field_count, Journal *journal, const int *frames)
{
    Text text = {0};
    const char *real =
        def->double_points ? "NumberType=\"Float\" Precision=\"8\"" : "NumberType=\"Float\" Precision=\"4\"";
    Field *known = mem_alloc((size_t)field_count, sizeof *known);
    int count = 0;
    for (int k = 0; k < field_count; k++)
        if (!strncmp(fields[k], "cell/", 5) || !strncmp(fields[k], "point/", 6))
            known[count++] = make_field(def, fields[k], journal, frames);
    text_add(&text, "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n"
                    "    <Grid Name=\"slender\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
    for (int step = 0; step < def->step_count; step++) {
        text_add(&text, "      <Grid Name=\"shell\" GridType=\"Uniform\">\n        <Time Value=\"%.17g\"/>\n",
                 def->times[step]);
        text_add(&text, "        <Topology TopologyType=\"Triangle\" NumberOfElements=\"%d\">",
                 def->face_count);
        add_item(&text, def, "Connectivity", 0, 3 * def->face_count, 1, 3 * def->face_count,
                 "NumberType=\"Int\" Precision=\"8\"");
        text_add(&text, "        </Topology>\n        <Geometry GeometryType=\"XYZ\">");
        add_item(&text, def, "Points", step * def->vertex_count, def->vertex_count, 3,
                 def->step_count * def->vertex_count, real);
        text_add(&text, "        </Geometry>\n");
        for (int k = 0; k < count; k++) add_field(&text, def, &known[k], step, real);
        text_add(&text, "      </Grid>\n");
    }
    text_add(&text, "    </Grid>\n  </Domain>\n</Xdmf>\n");
    for (int k = 0; k < count; k++) mem_free(known[k].first);
    mem_free(known);
    return text.text;
}
