/* Scalars of a scene: numbers, choices, texts, files. */
#include "base/memory.h"
#include "io/yaml_load.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- The path ---- */

size_t load_enter(Load *load, const char *key, int index)
{
    size_t length = strlen(load->path);
    char *end = load->path + length;
    size_t room = sizeof load->path - length;
    if (key)
        snprintf(end, room, "%s%s", length ? "." : "", key);
    else
        snprintf(end, room, "[%d]", index);
    return length;
}

void load_leave(Load *load, size_t length)
{
    load->path[length] = 0;
}

char *load_where(const Load *load)
{
    return load->path[0] ? mem_text(load->path) : mem_format("the %s", load->name);
}

bool load_wrong(Load *load, const Node *at, const char *what)
{
    char *where = load_where(load);
    yaml_error(load->file, at, "%s %s", where, what);
    mem_free(where);
    return false;
}

/* ---- Scalars ---- */

/* "(0, inf)", "[0, 0.5]": ends belong to it or not. */
static bool in_range(double value, const char *range)
{
    double low, high;
    char open = range[0], close = range[strlen(range) - 1];
    const char *comma = strchr(range, ',');
    low = strtod(range + 1, NULL);
    high = strtod(comma + 1, NULL);
    return (open == '[' ? value >= low : value > low) && (close == ']' ? value <= high : value < high);
}

const char *node_kind_name(const Node *node)
{
    return node->kind == NODE_LIST ? "a list" : node->kind == NODE_MAP ? "a mapping" : "a text";
}

bool load_number(Load *load, const YamlField *row, const Node *node, double *value)
{
    char what[400];
    if (node->kind != NODE_SCALAR) {
        snprintf(what, sizeof what, "must be a number%s%s, not %s", row->unit ? " in " : "",
                 row->unit ? row->unit : "", node_kind_name(node));
        return load_wrong(load, node, what);
    }
    if (!unit_parse(node->text, row->unit, value, what, sizeof what)) return load_wrong(load, node, what);
    if (!row->range || in_range(*value, row->range)) return true;
    snprintf(what, sizeof what, "is %g; it must be in %s%s%s", *value, row->range, row->unit ? " " : "",
             row->unit ? row->unit : "");
    return load_wrong(load, node, what);
}

bool load_integer(Load *load, const YamlField *row, const Node *node, int *value)
{
    double number;
    YamlField plain = *row;
    plain.unit = NULL;
    if (!load_number(load, &plain, node, &number)) return false;
    if (number != floor(number) || fabs(number) > INT_MAX) {
        char what[128];
        snprintf(what, sizeof what, "must be a whole number up to 2147483647, not '%.40s'", node->text);
        return load_wrong(load, node, what);
    }
    *value = (int)number;
    return true;
}

bool load_text(Load *load, const Node *node, char **value)
{
    if (node->kind != NODE_SCALAR) {
        char what[64];
        snprintf(what, sizeof what, "must be a text, not %s", node_kind_name(node));
        return load_wrong(load, node, what);
    }
    *value = mem_text(node->text);
    return true;
}

bool load_bool(Load *load, const Node *node, bool *value)
{
    bool yes = node->kind == NODE_SCALAR && !strcmp(node->text, "true");
    if (!yes && (node->kind != NODE_SCALAR || strcmp(node->text, "false")))
        return load_wrong(load, node, "must be true or false");
    *value = yes;
    return true;
}

static const char *choice_word(const void *self, int i)
{
    return ((const char *const *)self)[i];
}

bool load_choice(Load *load, const YamlField *row, const Node *node, int *value)
{
    for (int k = 0; node->kind == NODE_SCALAR && row->choices[k]; k++)
        if (!strcmp(node->text, row->choices[k])) return *value = k, true;
    char what[512];
    int length = snprintf(what, sizeof what, "must be ");
    for (int k = 0; row->choices[k] && length < 400; k++)
        length += snprintf(what + length, sizeof what - (size_t)length, "%s%s",
                           k == 0                ? ""
                           : row->choices[k + 1] ? ", "
                                                 : " or ",
                           row->choices[k]);
    if (node->kind == NODE_SCALAR) {
        const char *near = nearest_word(load->file, node->text, choice_word, row->choices);
        length += snprintf(what + length, sizeof what - (size_t)length, ", not '%.40s'", node->text);
        if (near && length < 480)
            snprintf(what + length, sizeof what - (size_t)length, "; did you mean '%s'?", near);
    }
    return load_wrong(load, node, what);
}

bool load_file(Load *load, const Node *node, char **value)
{
    char *text = NULL;
    if (!load_text(load, node, &text)) return false;
    if (!*text) {
        mem_free(text);
        return load_wrong(load, node, "must name a file");
    }
    *value = *text == '/' ? mem_text(text) : mem_format("%s/%s", load->file->folder, text);
    mem_free(text);
    return true;
}
