/* What a field table says of itself: JSON Schema for editors, the manual for readers, and a check for its
 * tests. */
#include "base/memory.h"
#include "io/text.h"
#include "io/yaml_private.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { TABLES_MAX = 128 };

/* All tables below a root, each once, in order of appearance. */
typedef struct Tables {
    int count;
    const YamlTable *tables[TABLES_MAX];
} Tables;

static void collect(Tables *tables, const YamlTable *table)
{
    for (int k = 0; k < tables->count; k++)
        if (tables->tables[k] == table) return;
    assert(tables->count < TABLES_MAX);
    tables->tables[tables->count++] = table;
    for (const YamlField *row = table->fields; row->key; row++)
        if (row->table) collect(tables, row->table);
}

/* ---- Schema ---- */

/* A number, or a number with a unit in a text; ranges hold for plain numbers. */
static void schema_number(Text *text, const YamlField *row)
{
    text_add(text, row->unit ? "{\"type\": [\"number\", \"string\"]"
                   : row->kind == FIELD_INTEGER || row->kind == FIELD_INTEGERS ? "{\"type\": \"integer\""
                                                                               : "{\"type\": \"number\"");
    if (row->range) {
        const char *comma = strchr(row->range, ',');
        bool low_open = row->range[0] == '(', high_open = row->range[strlen(row->range) - 1] == ')';
        char number[40];
        if (strncmp(row->range + 1, "-inf", 4)) {
            number_format(strtod(row->range + 1, NULL), number);
            text_add(text, ", \"%s\": %s", low_open ? "exclusiveMinimum" : "minimum", number);
        }
        if (!strstr(comma, "inf")) {
            number_format(strtod(comma + 1, NULL), number);
            text_add(text, ", \"%s\": %s", high_open ? "exclusiveMaximum" : "maximum", number);
        }
    }
    text_add(text, "}");
}

static void schema_choice(Text *text, const YamlField *row)
{
    text_add(text, "{\"enum\": [");
    for (int k = 0; row->choices[k]; k++) {
        if (k) text_add(text, ", ");
        text_add_quoted(text, row->choices[k]);
    }
    text_add(text, "]}");
}

static void schema_reference(Text *text, const YamlTable *table)
{
    text_add(text, "{\"$ref\": ");
    char *path = mem_format("#/definitions/%s", table->name);
    text_add_quoted(text, path);
    mem_free(path);
    text_add(text, "}");
}

static void schema_entry(Text *text, const YamlField *row)
{
    switch (row->kind) {
    case FIELD_NUMBERS:
    case FIELD_INTEGERS:
        schema_number(text, row);
        break;
    case FIELD_TEXTS:
        text_add(text, "{\"type\": [\"string\", \"number\"]}");
        break;
    case FIELD_CHOICES:
        schema_choice(text, row);
        break;
    case FIELD_LIST:
        schema_reference(text, row->table);
        break;
    default: /* FIELD_ROWS */
        text_add(text, "{\"type\": \"array\", \"minItems\": %d, \"maxItems\": %d, \"items\": ", row->width,
                 row->width);
        schema_number(text, row);
        text_add(text, "}");
    }
}

static void schema_list(Text *text, const YamlField *row)
{
    int least = row->count_offset ? row->min_count : row->width,
        most = row->count_offset ? row->max_count : row->width;
    bool scalars = row->kind == FIELD_NUMBERS || row->kind == FIELD_INTEGERS || row->kind == FIELD_CHOICES,
         alone = row->alone || (row->count_offset && scalars);
    if (alone) {
        text_add(text, "{\"anyOf\": [");
        schema_entry(text, row);
        text_add(text, ", ");
    }
    text_add(text, "{\"type\": \"array\"");
    if (least) text_add(text, ", \"minItems\": %d", least);
    if (most) text_add(text, ", \"maxItems\": %d", most);
    text_add(text, ", \"items\": ");
    schema_entry(text, row);
    text_add(text, alone ? "}]}" : "}");
}

static void schema_value(Text *text, const YamlField *row)
{
    switch (row->kind) {
    case FIELD_NUMBER:
    case FIELD_INTEGER:
        schema_number(text, row);
        break;
    case FIELD_BOOL:
        text_add(text, "{\"type\": \"boolean\"}");
        break;
    case FIELD_TEXT:
        text_add(text, "{\"type\": [\"string\", \"number\"]}");
        break;
    case FIELD_FILE:
        text_add(text, "{\"type\": \"string\"}");
        break;
    case FIELD_CHOICE:
        schema_choice(text, row);
        break;
    case FIELD_TABLE:
    case FIELD_OPTIONAL:
        schema_reference(text, row->table);
        break;
    case FIELD_MAP:
        text_add(text, "{\"type\": \"object\", \"additionalProperties\": ");
        schema_reference(text, row->table);
        text_add(text, "}");
        break;
    default:
        schema_list(text, row);
    }
}

/* The property, its description beside it: draft-07 ignores what stands beside a $ref, so both go into allOf.
 */
static void schema_property(Text *text, const YamlField *row, const char *key)
{
    text_add(text, "        ");
    text_add_quoted(text, key);
    text_add(text, ": {\"description\": ");
    char *doc = mem_format("%s%s%s%s", row->doc, row->unit ? " [" : "", row->unit ? row->unit : "",
                           row->unit ? "]" : "");
    text_add_quoted(text, doc);
    mem_free(doc);
    text_add(text, ", \"allOf\": [");
    schema_value(text, row);
    text_add(text, "]}");
}

static void schema_object(Text *text, const YamlTable *table, bool root)
{
    text_add(text, "{\"type\": \"object\", \"description\": ");
    text_add_quoted(text, table->doc);
    text_add(text, ", \"additionalProperties\": false, \"properties\": {\n");
    if (root)
        text_add(text, "        \"slender\": {\"description\": \"the format's version\", \"const\": 1}");
    for (const YamlField *row = table->fields; row->key; row++) {
        if (root || row != table->fields) text_add(text, ",\n");
        schema_property(text, row, row->key);
        for (int k = 0; row->also && row->also[k]; k++) {
            text_add(text, ",\n");
            schema_property(text, row, row->also[k]);
        }
    }
    text_add(text, "\n      }");
    int required = 0;
    if (root) text_add(text, ", \"required\": [\"slender\""), required++;
    for (const YamlField *row = table->fields; row->key; row++) {
        if (!row->required || row->one_of) continue;
        text_add(text, required++ ? ", " : ", \"required\": [");
        text_add_quoted(text, row->key);
    }
    text_add(text, required ? "]}" : "}");
}

static void schema_table(Text *text, const YamlTable *table)
{
    bool short_form = false;
    for (const YamlField *row = table->fields; row->key; row++) short_form |= row->short_form;
    text_add(text, "    ");
    text_add_quoted(text, table->name);
    text_add(text, ": ");
    if (short_form) text_add(text, "{\"anyOf\": [");
    schema_object(text, table, false);
    for (const YamlField *row = table->fields; row->key; row++) {
        if (!row->short_form) continue;
        text_add(text, ", ");
        schema_value(text, row);
    }
    if (short_form) text_add(text, "]}");
}

char *yaml_schema(const YamlTable *table, const char *title)
{
    Tables tables = {0};
    collect(&tables, table);
    Text text = {0};
    text_add(&text, "{\n  \"$schema\": \"http://json-schema.org/draft-07/schema#\",\n  \"title\": ");
    text_add_quoted(&text, title);
    text_add(&text, ",\n  \"definitions\": {\n");
    for (int k = 1; k < tables.count; k++) {
        schema_table(&text, tables.tables[k]);
        text_add(&text, k + 1 < tables.count ? ",\n" : "\n");
    }
    text_add(&text, "  },\n  \"allOf\": [");
    schema_object(&text, table, true);
    text_add(&text, "]\n}\n");
    return text.text;
}

/* ---- Manual ---- */

/* A section's name as an anchor: without blanks. */
static void manual_anchor(Text *text, const char *name)
{
    for (; *name; name++) text_add(text, "%c", *name == ' ' ? '-' : *name);
}

static void manual_link(Text *text, const char *before, const char *name)
{
    text_add(text, "%s[%s](#", before, name);
    manual_anchor(text, name);
    text_add(text, ")");
}

static void manual_kind(Text *text, const YamlField *row)
{
    static const char *const names[] = {[FIELD_NUMBER] = "number",
                                        [FIELD_INTEGER] = "whole number",
                                        [FIELD_BOOL] = "true or false",
                                        [FIELD_TEXT] = "text",
                                        [FIELD_FILE] = "file",
                                        [FIELD_CHOICE] = "one of",
                                        [FIELD_NUMBERS] = "numbers",
                                        [FIELD_INTEGERS] = "whole numbers",
                                        [FIELD_TEXTS] = "texts",
                                        [FIELD_CHOICES] = "some of",
                                        [FIELD_ROWS] = "rows of numbers",
                                        [FIELD_TABLE] = "",
                                        [FIELD_OPTIONAL] = "",
                                        [FIELD_LIST] = "list of",
                                        [FIELD_MAP] = "names with"};
    if (row->width)
        text_add(text, row->kind == FIELD_ROWS ? "rows of %d numbers" : "%d numbers", row->width);
    else
        text_add(text, "%s", names[row->kind]);
    for (int k = 0; row->choices && row->choices[k]; k++)
        text_add(text, "%s `%s`", k ? "," : "", row->choices[k]);
    if (row->table) manual_link(text, names[row->kind][0] ? " " : "", row->table->name);
    if (row->alone) text_add(text, ", or one alone");
    if (row->unit) text_add(text, ", %s", row->unit);
    if (row->range) text_add(text, ", in %s", row->range);
}

/* "/job: simulate & !curve" as " (with `job: simulate`, without `curve`)". */
static void manual_when(Text *text, const char *when)
{
    for (int k = 0; when && *when; k++) {
        bool absent = *when == '!';
        when += strspn(when, "/!");
        size_t length = strcspn(when, "&"), end = strcspn(when, "{&");
        while (end && when[end - 1] == ' ') end--;
        text_add(text, "%s%s `", k ? ", " : " (", absent ? "without" : "with");
        for (size_t i = 0; i < end; i++) text_add(text, when[i] == '|' ? "\\|" : "%c", when[i]);
        text_add(text, "`");
        when += length + strspn(when + length, "& ");
        if (!*when) text_add(text, ")");
    }
}

static void manual_row(Text *text, const YamlField *row)
{
    text_add(text, "| `%s`", row->key);
    for (int k = 0; row->also && row->also[k]; k++) text_add(text, ", `%s`", row->also[k]);
    text_add(text, " | ");
    manual_kind(text, row);
    text_add(text, " | ");
    if (row->fallback)
        text_add(text, "`%s`", row->fallback);
    else if (row->required)
        text_add(text, row->one_of ? "one of these (%d)" : "needed", row->one_of);
    else if (row->one_of)
        text_add(text, "one of these (%d)", row->one_of);
    text_add(text, " | %s%s", row->doc, row->short_form ? "; may stand alone" : "");
    manual_when(text, row->when);
    text_add(text, " |\n");
}

static void manual_units(Text *text)
{
    text_add(text, "## <a name=\"units\"></a>units\n\nA number may carry a unit of the kind that its key "
                   "has, `1.5 mm` or `1.5mm`; "
                   "without one it is in that of its key. Units are ");
    unit_list(true, "`", text);
    text_add(text, ", which take the prefixes ");
    unit_list_prefixes("`", text);
    text_add(text, " (`\xc2\xb5` is `u`), and ");
    unit_list(false, "`", text);
    text_add(text, "; and products of them with powers and one slash: `kN/m^2`, `N s/m`, `1/mm`.\n");
}

char *yaml_manual(const YamlTable *table, const char *title)
{
    Tables tables = {0};
    collect(&tables, table);
    Text text = {0};
    text_add(&text,
             "# %s\n\nMade by `slender schema --manual` from the field tables of the program; do not edit. "
             "What formulas may say is in formulas.md, units and --set are in units.md.\n\n",
             title);
    for (int k = 0; k < tables.count; k++) {
        text_add(&text, "## <a name=\"");
        manual_anchor(&text, tables.tables[k]->name);
        text_add(&text, "\"></a>%s\n\n%s\n\n", tables.tables[k]->name, tables.tables[k]->doc);
        text_add(&text, "| key | value | default | meaning |\n|---|---|---|---|\n");
        for (const YamlField *row = tables.tables[k]->fields; row->key; row++) manual_row(&text, row);
        text_add(&text, "\n");
    }
    manual_units(&text);
    return text.text;
}

/* ---- Keys ---- */

static void key_lines(Text *text, const YamlTable *table, const char *before);

static void key_line(Text *text, const YamlField *row, const char *key)
{
    static const char *const truth[] = {"true", "false", NULL};
    const char *const *words = row->kind == FIELD_CHOICE ? row->choices
                               : row->kind == FIELD_BOOL ? truth
                                                         : NULL;
    if (!words) text_add(text, "%s=\n", key);
    for (int k = 0; words && words[k]; k++) text_add(text, "%s=%s\n", key, words[k]);
    if (!row->table || row->kind == FIELD_MAP) return;
    char *below = mem_format(row->kind == FIELD_LIST ? "%s[0]." : "%s.", key);
    key_lines(text, row->table, below);
    mem_free(below);
}

static void key_lines(Text *text, const YamlTable *table, const char *before)
{
    for (const YamlField *row = table->fields; row->key; row++) {
        char *key = mem_format("%s%s", before, row->key);
        key_line(text, row, key);
        mem_free(key);
    }
}

char *yaml_keys(const YamlTable *table)
{
    Text text = {0};
    key_lines(&text, table, "");
    return text.text;
}

/* ---- Check ---- */

static void check_row(const YamlField *row)
{
    assert(row->doc && unit_is_known(row->unit));
    assert(!row->range || (strchr("([", row->range[0]) && strchr(row->range, ',')));
    bool choice = row->kind == FIELD_CHOICE || row->kind == FIELD_CHOICES, table = row->kind >= FIELD_TABLE;
    assert(choice == (row->choices != NULL) && table == (row->table != NULL));
    (void)choice, (void)table; /* where asserts are off */
    assert(!row->fallback || (!row->required && row->kind != FIELD_BOOL));
}

void yaml_check_table(const YamlTable *table)
{
    Tables tables = {0};
    collect(&tables, table);
    for (int k = 0; k < tables.count; k++) {
        assert(tables.tables[k]->name && tables.tables[k]->doc);
        for (int i = 0; i < k; i++) assert(strcmp(tables.tables[i]->name, tables.tables[k]->name));
        for (const YamlField *row = tables.tables[k]->fields; row->key; row++) {
            check_row(row);
            assert(row_use_is_sound(table, tables.tables[k], row));
            assert(row->table != tables.tables[k]);
            if (!row->fallback) continue;
            /* The default must load: a table of this one row, filled from nothing. */
            YamlTable alone = {.name = "default",
                               .doc = "",
                               .size = tables.tables[k]->size,
                               .fields = (const YamlField[]){*row, {0}}};
            void *scene = mem_alloc(1, alone.size);
            YamlFile *file = yaml_parse("default", "slender: 1", 10);
            bool ok = yaml_load(file, &alone, scene);
            assert(ok);
            (void)ok;
            yaml_clear(&alone, scene);
            yaml_destroy(file);
            mem_free(scene);
        }
    }
}
