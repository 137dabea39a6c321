/* Rows of a table that exclude each other (YamlField.one_of). */
#include "base/memory.h"
#include "io/yaml_load.h"
#include <stdio.h>
#include <string.h>

static bool is_given(const YamlField *row, const Node *node)
{
    const Node *item = load_row_item(row, node);
    return item && !(row->kind == FIELD_BOOL && item->kind == NODE_SCALAR && strcmp(item->text, "true"));
}

/* "; it may be auto or a whole number alone": what stands for a row of the group without its key. */
static char *alone_text(const YamlTable *table, int group)
{
    static const char *const kinds[] = {[FIELD_NUMBER] = "a number",
                                        [FIELD_INTEGER] = "a whole number",
                                        [FIELD_TEXT] = "a text",
                                        [FIELD_FILE] = "a file"};
    char *text = mem_text("");
    for (const YamlField *row = table->fields; row->key; row++) {
        if (row->one_of != group || !row->short_form) continue;
        bool simple = row->kind < (int)(sizeof kinds / sizeof *kinds) && kinds[row->kind];
        for (int k = 0; row->choices ? row->choices[k] != NULL : k < simple; k++)
            text = mem_join(text, *text ? " or " : "; it may be ",
                            row->choices ? row->choices[k] : kinds[row->kind]);
    }
    return *text ? mem_join(text, " alone", "") : text;
}

bool load_check_group(Load *load, const YamlTable *table, const Node *node, int group)
{
    char given[200] = "", all[300] = "";
    int count = 0;
    bool required = false, misspelt = false;
    for (const YamlField *row = table->fields; row->key; row++) {
        if (row->one_of != group) continue;
        required |= row->required;
        misspelt |= row->required && load_is_misspelt(load, table, node, row);
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", all[0] ? ", " : "", row->key);
        if (!is_given(row, node)) continue;
        snprintf(given + strlen(given), sizeof given - strlen(given), "%s%s", count++ ? " and " : "",
                 row->key);
    }
    char what[600] = "", *alone = alone_text(table, group);
    if (count > 1)
        snprintf(what, sizeof what, "has %s; give only one of %s", given, all);
    else if (count == 0 && required && !misspelt)
        snprintf(what, sizeof what, "needs one of %s%s", all, alone);
    mem_free(alone);
    return !*what || load_wrong(load, node, what);
}

bool load_group_is_given(const YamlTable *table, const Node *node, int group)
{
    for (const YamlField *row = table->fields; row->key; row++)
        if (row->one_of == group && is_given(row, node)) return true;
    return false;
}
