/* PLY 1.0, ASCII and binary of either byte order: elements vertex (x, y, z) and face (a list of vertices);
 * other elements and properties are passed over. Source: G. Turk, The PLY Polygon File Format (1994). */
#include "io/mesh_reader.h"
#include "io/polygon.h"
#include <math.h>
#include <string.h>

enum { ELEMENTS_MAX = 16, PROPERTIES_MAX = 64 };

typedef enum Meaning { MEANING_NONE, MEANING_X, MEANING_Y, MEANING_Z, MEANING_CORNERS } Meaning;

typedef enum Type {
    TYPE_INT8,
    TYPE_UINT8,
    TYPE_INT16,
    TYPE_UINT16,
    TYPE_INT32,
    TYPE_UINT32,
    TYPE_FLOAT32,
    TYPE_FLOAT64,
    TYPE_COUNT
} Type;

static const struct {
    const char *names[2];
    int size; /* bytes */
} types[TYPE_COUNT] = {
    [TYPE_INT8] = {{"char", "int8"}, 1},        [TYPE_UINT8] = {{"uchar", "uint8"}, 1},
    [TYPE_INT16] = {{"short", "int16"}, 2},     [TYPE_UINT16] = {{"ushort", "uint16"}, 2},
    [TYPE_INT32] = {{"int", "int32"}, 4},       [TYPE_UINT32] = {{"uint", "uint32"}, 4},
    [TYPE_FLOAT32] = {{"float", "float32"}, 4}, [TYPE_FLOAT64] = {{"double", "float64"}, 8}};

typedef struct Property {
    bool list;
    Type type, count_type; /* of the value or the list's entries; of a list's length */
    Meaning meaning;
} Property;

typedef struct Element {
    enum { ELEMENT_OTHER, ELEMENT_VERTEX, ELEMENT_FACE } kind;
    long count;
    int property_count;
    Property properties[PROPERTIES_MAX];
} Element;

typedef struct Ply {
    Scan *scan;
    MeshReader *reader;
    enum { FORMAT_NONE, FORMAT_ASCII, FORMAT_LITTLE, FORMAT_BIG } format;
    int element_count;
    Element elements[ELEMENTS_MAX];
} Ply;

/* ---- The header ---- */

static bool read_element(Scan *scan, Ply *header)
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

static bool read_type(Scan *scan, Type *type)
{
    Word word;
    if (!scan_word(scan, &word)) return scan_refuse(scan, "the property's type is missing");
    for (int k = 0; k < TYPE_COUNT; k++)
        if (word_is(word, types[k].names[0]) || word_is(word, types[k].names[1]))
            return *type = (Type)k, true;
    return scan_refuse_at(scan, word.text, "'%.*s' is no type of a PLY file",
                          word.length > 40 ? 40 : word.length, word.text);
}

static Meaning meaning_of(const Element *element, const Property *property, Word name)
{
    if (element->kind == ELEMENT_VERTEX && !property->list)
        return word_is(name, "x")   ? MEANING_X
               : word_is(name, "y") ? MEANING_Y
               : word_is(name, "z") ? MEANING_Z
                                    : MEANING_NONE;
    bool corners = word_is(name, "vertex_indices") || word_is(name, "vertex_index");
    return element->kind == ELEMENT_FACE && property->list && corners ? MEANING_CORNERS : MEANING_NONE;
}

static bool read_property(Scan *scan, Ply *header)
{
    if (header->element_count == 0) return scan_refuse(scan, "a property before the first element");
    Element *element = &header->elements[header->element_count - 1];
    if (element->property_count == PROPERTIES_MAX)
        return scan_refuse(scan, "more than %d properties", PROPERTIES_MAX);
    Property *property = &element->properties[element->property_count++];
    Word name;
    Scan list = *scan;
    property->list = scan_word(&list, &name) && word_is(name, "list");
    if (property->list) scan_word(scan, &name);
    if ((property->list && !read_type(scan, &property->count_type)) || !read_type(scan, &property->type))
        return false;
    if (!scan_word(scan, &name)) return scan_refuse(scan, "the property's name is missing");
    property->meaning = meaning_of(element, property, name);
    return true;
}

static bool read_format(Scan *scan, Ply *header)
{
    static const char *const formats[] = {[FORMAT_ASCII] = "ascii",
                                          [FORMAT_LITTLE] = "binary_little_endian",
                                          [FORMAT_BIG] = "binary_big_endian"};
    Word format, version;
    if (scan_word(scan, &format) && scan_word(scan, &version) && word_is(version, "1.0"))
        for (int k = FORMAT_ASCII; k <= FORMAT_BIG; k++)
            if (word_is(format, formats[k])) return header->format = k, true;
    return scan_refuse(scan, "the format must be ascii, binary_little_endian or binary_big_endian, and 1.0");
}

static bool read_header(Scan *scan, Ply *header)
{
    Word word;
    if (!scan_line(scan) || !scan_word(scan, &word) || !word_is(word, "ply")) {
        if (scan->line == 0) scan->line = 1;
        return scan_refuse(scan, "a PLY file begins with the word ply");
    }
    while (scan_line(scan)) {
        scan_word(scan, &word);
        bool ok = true;
        if (word_is(word, "end_header"))
            return header->format || scan_refuse(scan, "the format is missing, e.g. format ascii 1.0");
        if (word_is(word, "format"))
            ok = read_format(scan, header);
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

/* ---- Values ---- */

/* A value of the file's bytes, whatever the order of this machine's. */
static double decode(const unsigned char *bytes, Type type, bool big)
{
    unsigned char order[8];
    int size = types[type].size;
    uint64_t bits = 0;
    for (int k = 0; k < size; k++) order[k] = bytes[big ? size - 1 - k : k];
    for (int k = size; k-- > 0;) bits = bits << 8 | order[k];
    if (type == TYPE_FLOAT64) {
        double value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    if (type == TYPE_FLOAT32) {
        uint32_t low = (uint32_t)bits;
        float value;
        memcpy(&value, &low, sizeof value);
        return (double)value;
    }
    bool is_signed = type == TYPE_INT8 || type == TYPE_INT16 || type == TYPE_INT32;
    double range = ldexp(1, 8 * size), value = (double)bits;
    return is_signed && value >= range / 2 ? value - range : value;
}

/* The next value of the entry, a word or some bytes. */
static bool next_value(Ply *ply, Type type, const char *what, double *value)
{
    Scan *scan = ply->scan;
    if (ply->format == FORMAT_ASCII) return scan_number(scan, what, value);
    if (scan->end - scan->next < types[type].size)
        return scan_refuse(scan, "the file ends where %s should be", what);
    *value = decode((const unsigned char *)scan->next, type, ply->format == FORMAT_BIG);
    scan->next += types[type].size;
    return isfinite(*value) || scan_refuse(scan, "%s must be a finite number, not %g", what, *value);
}

static bool next_index(Ply *ply, Type type, const char *what, long *value)
{
    double number;
    if (!next_value(ply, type, what, &number)) return false;
    *value = (long)fmin(fmax(number, -1), READER_MAX_INDEX);
    return (double)*value == number ||
           scan_refuse(ply->scan, "%s must be a whole number from 0 to %d, not %g", what, READER_MAX_INDEX,
                       number);
}

/* ---- Entries ---- */

static bool read_corners(Ply *ply, const Property *property)
{
    int corners[POLYGON_MAX_CORNERS];
    long count, corner;
    if (!next_index(ply, property->count_type, "the number of corners", &count)) return false;
    if (count > POLYGON_MAX_CORNERS) return reader_add_face(ply->reader, ply->scan, corners, (int)count);
    for (long i = 0; i < count; i++) {
        if (!next_index(ply, property->type, "a corner", &corner)) return false;
        corners[i] = (int)corner;
    }
    return reader_add_face(ply->reader, ply->scan, corners, (int)count);
}

static bool skip_property(Ply *ply, const Property *property)
{
    long count = 1;
    double number;
    if (property->list && !next_index(ply, property->count_type, "a list's length", &count)) return false;
    for (; count > 0; count--)
        if (!next_value(ply, property->type, "a property", &number)) return false;
    return true;
}

static bool read_entry(Ply *ply, const Element *element)
{
    double x[3] = {0};
    for (int k = 0; k < element->property_count; k++) {
        const Property *property = &element->properties[k];
        bool ok;
        if (property->meaning == MEANING_CORNERS)
            ok = read_corners(ply, property);
        else if (property->meaning == MEANING_NONE)
            ok = skip_property(ply, property);
        else
            ok = next_value(ply, property->type, "a coordinate", &x[property->meaning - MEANING_X]);
        if (!ok) return false;
    }
    if (element->kind == ELEMENT_VERTEX) reader_add_vertex(ply->reader, x, ply->scan->line);
    return ply->format != FORMAT_ASCII || scan_line_ends(ply->scan);
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

static bool next_entry(Ply *ply, const Element *element)
{
    Scan *scan = ply->scan;
    bool more = ply->format == FORMAT_ASCII ? scan_line(scan) : scan->next < scan->end;
    return more || scan_refuse(scan, "the file ends before its %ld %s", element->count,
                               element->kind == ELEMENT_VERTEX ? "vertices"
                               : element->kind == ELEMENT_FACE ? "faces"
                                                               : "entries");
}

static bool read_entries(Ply *ply, const Element *element)
{
    if (!check_element(ply->scan, element)) return false;
    if (element->property_count == 0) return true;
    for (long k = 0; k < element->count; k++)
        if (!next_entry(ply, element) || !read_entry(ply, element)) return false;
    return true;
}

/* After the last element: a header that counts too few would lose the rest. */
static bool check_end(Ply *ply)
{
    Scan *scan = ply->scan;
    bool more = ply->format == FORMAT_ASCII ? scan_line(scan) : scan->next < scan->end;
    return !more || scan_refuse(scan, "there is more than the header's elements count%s",
                                ply->format == FORMAT_ASCII ? "" : ": the file goes on behind them");
}

bool mesh_read_ply(Scan *scan, MeshReader *reader)
{
    Ply ply = {.scan = scan, .reader = reader};
    bool ok = read_header(scan, &ply) && (ply.format > FORMAT_ASCII || scan_check_text(scan));
    for (int e = 0; ok && e < ply.element_count; e++) ok = read_entries(&ply, &ply.elements[e]);
    ok = ok && check_end(&ply) && reader_finish(reader, scan, 0);
    if (ply.format > FORMAT_ASCII) reader_drop_lines(reader);
    return ok;
}
