/* PLY 1.0, ASCII: elements vertex (x, y, z) and face (a list of vertices); other elements and properties are
 * passed over. */
#include "io/mesh_reader.h"

enum { ELEMENTS_MAX = 16, PROPERTIES_MAX = 64 };

typedef enum Meaning { MEANING_NONE, MEANING_X, MEANING_Y, MEANING_Z, MEANING_CORNERS } Meaning;

typedef struct Property {
    bool list;
    Meaning meaning;
} Property;

typedef struct Element {
    enum { ELEMENT_OTHER, ELEMENT_VERTEX, ELEMENT_FACE } kind;
    long count;
    int property_count;
    Property properties[PROPERTIES_MAX];
} Element;

typedef struct Header {
    int element_count;
    Element elements[ELEMENTS_MAX];
} Header;

static bool read_element(Scan *scan, Header *header)
{
    Word name;
    if (header->element_count == ELEMENTS_MAX)
        return scan_refuse(scan, "more than %d elements", ELEMENTS_MAX);
    if (!scan_word(scan, &name)) return scan_refuse(scan, "the element's name is missing");
    Element *element = &header->elements[header->element_count++];
    if (word_is(name, "vertex")) element->kind = ELEMENT_VERTEX;
    if (word_is(name, "face")) element->kind = ELEMENT_FACE;
    return scan_integer(scan, "the element's count", 0, READER_MAX_INDEX, &element->count);
}

static bool read_property(Scan *scan, Header *header)
{
    if (header->element_count == 0) return scan_refuse(scan, "a property before the first element");
    Element *element = &header->elements[header->element_count - 1];
    if (element->property_count == PROPERTIES_MAX)
        return scan_refuse(scan, "more than %d properties", PROPERTIES_MAX);
    Property *property = &element->properties[element->property_count++];
    Word type, name;
    if (!scan_word(scan, &type)) return scan_refuse(scan, "the property's type is missing");
    property->list = word_is(type, "list");
    for (int skip = property->list ? 2 : 0; skip > 0; skip--)
        if (!scan_word(scan, &type)) return scan_refuse(scan, "the list's types are missing");
    if (!scan_word(scan, &name)) return scan_refuse(scan, "the property's name is missing");
    if (element->kind == ELEMENT_VERTEX && !property->list)
        property->meaning = word_is(name, "x")   ? MEANING_X
                            : word_is(name, "y") ? MEANING_Y
                            : word_is(name, "z") ? MEANING_Z
                                                 : MEANING_NONE;
    if (element->kind == ELEMENT_FACE && property->list &&
        (word_is(name, "vertex_indices") || word_is(name, "vertex_index")))
        property->meaning = MEANING_CORNERS;
    return true;
}

static bool read_format(Scan *scan)
{
    Word format = {0}, version = {0};
    if (scan_word(scan, &format) && word_is(format, "ascii") && scan_word(scan, &version) &&
        word_is(version, "1.0"))
        return true;
    if (format.length && word_begins(format, "binary"))
        return scan_refuse(scan,
                           "a binary PLY file: save it as ASCII (in Blender or MeshLab: untick 'binary')");
    return scan_refuse(scan, "the format must be ascii 1.0");
}

static bool read_header(Scan *scan, Header *header)
{
    Word word;
    bool formatted = false;
    if (!scan_line(scan) || !scan_word(scan, &word) || !word_is(word, "ply")) {
        if (scan->line == 0) scan->line = 1;
        return scan_refuse(scan, "a PLY file begins with the word ply");
    }
    while (scan_line(scan)) {
        scan_word(scan, &word);
        bool ok = true;
        if (word_is(word, "end_header"))
            return formatted || scan_refuse(scan, "the format is missing: ascii 1.0");
        if (word_is(word, "format"))
            ok = formatted = read_format(scan);
        else if (word_is(word, "element"))
            ok = read_element(scan, header);
        else if (word_is(word, "property"))
            ok = read_property(scan, header);
        else if (!word_is(word, "comment") && !word_is(word, "obj_info"))
            ok = scan_refuse(scan, "'%.*s' is no word of a PLY header", word.length > 40 ? 40 : word.length,
                             word.text);
        if (!ok) return false;
    }
    return scan_refuse(scan, "the header does not end");
}

static bool read_corners(Scan *scan, MeshReader *reader)
{
    long count, value;
    int v[3];
    if (!scan_integer(scan, "the number of corners", 0, READER_MAX_INDEX, &count)) return false;
    if (count != 3) return scan_refuse(scan, "a face with %ld corners: slender takes triangles only", count);
    for (int i = 0; i < 3; i++) {
        if (!scan_integer(scan, "a corner", 0, READER_MAX_INDEX, &value)) return false;
        v[i] = (int)value;
    }
    reader_add_face(reader, v, scan->line);
    return true;
}

static bool skip_property(Scan *scan, bool list)
{
    long count = 1;
    double number;
    if (list && !scan_integer(scan, "a list's length", 0, READER_MAX_INDEX, &count)) return false;
    for (; count > 0; count--)
        if (!scan_number(scan, "a property", &number)) return false;
    return true;
}

static bool read_entry(Scan *scan, MeshReader *reader, const Element *element)
{
    double x[3] = {0};
    for (int k = 0; k < element->property_count; k++) {
        const Property *property = &element->properties[k];
        bool ok;
        if (property->meaning == MEANING_CORNERS)
            ok = read_corners(scan, reader);
        else if (property->meaning == MEANING_NONE)
            ok = skip_property(scan, property->list);
        else
            ok = scan_number(scan, "a coordinate", &x[property->meaning - MEANING_X]);
        if (!ok) return false;
    }
    if (element->kind == ELEMENT_VERTEX) reader_add_vertex(reader, x, scan->line);
    return true;
}

/* Vertices need x, y and z, faces their corners. */
static bool check_element(Scan *scan, const Element *element)
{
    int seen = 0;
    for (int k = 0; k < element->property_count; k++) seen |= 1 << element->properties[k].meaning;
    if (element->kind == ELEMENT_VERTEX && (seen & 0xe) != 0xe)
        return scan_refuse(scan, "vertices need the properties x, y and z");
    if (element->kind == ELEMENT_FACE && !(seen & 0x10))
        return scan_refuse(scan, "faces need the list property vertex_indices");
    return true;
}

static bool check_corners(Scan *scan, const MeshFile *mesh)
{
    for (int f = 0; f < mesh->face_count; f++)
        for (int i = 0; i < 3; i++) {
            if (mesh->faces[f][i] < mesh->vertex_count) continue;
            scan->line = mesh->face_line[f];
            return scan_refuse(scan, "vertex %d does not exist: there are %d, from 0", mesh->faces[f][i],
                               mesh->vertex_count);
        }
    return true;
}

bool mesh_read_ply(Scan *scan, MeshReader *reader)
{
    Header header = {0};
    if (!read_header(scan, &header)) return false;
    for (int e = 0; e < header.element_count; e++) {
        const Element *element = &header.elements[e];
        if (!check_element(scan, element)) return false;
        for (long k = 0; k < element->count; k++) {
            if (!scan_line(scan))
                return scan_refuse(scan, "the file ends before its %ld %s", element->count,
                                   element->kind == ELEMENT_VERTEX ? "vertices"
                                   : element->kind == ELEMENT_FACE ? "faces"
                                                                   : "entries");
            if (!read_entry(scan, reader, element)) return false;
        }
    }
    return check_corners(scan, reader->mesh);
}
