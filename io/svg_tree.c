#include "io/svg_tree.h"
#include "base/memory.h"
#include "io/text.h"
#include <expat.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { CHUNK = 1 << 20, DEPTH_MOST = 1000 };

static const char *const blanks = " \t\r\n\f";

/* What moves or hides. */
static const char *const properties[] = {"display", "visibility", "transform", "transform-origin"};

typedef struct Reader {
    XML_Parser parser;
    SvgTree *tree;
    SvgNode *open; /* the innermost one */
    int depth;
    Text style; /* of the open <style> */
    const char *path;
    Error *err;
    bool ok;
} Reader;

/* ---- Texts ---- */

static size_t trim(const char **text, size_t length)
{
    while (length && strchr(blanks, **text)) ++*text, length--;
    while (length && strchr(blanks, (*text)[length - 1])) length--;
    return length;
}

static char *copy(const char *text, size_t length)
{
    length = trim(&text, length);
    return mem_format("%.*s", (int)length, text);
}

/* The last declaration of a property in "a: b; c: d"; NULL: none. */
static char *declared(const char *text, const char *name)
{
    char *found = NULL;
    while (*text) {
        size_t length = strcspn(text, ";"), key = strcspn(text, ":;");
        const char *start = text;
        size_t size = trim(&start, key);
        if (key < length && size == strlen(name) && !strncasecmp(start, name, size)) {
            mem_free(found);
            const char *value = text + key + 1, *end = strstr(value, "!important");
            found = copy(value, end && end < text + length ? (size_t)(end - value) : length - key - 1);
        }
        text += length + (text[length] == ';');
    }
    return found;
}

static bool matters(const char *declarations)
{
    bool any = false;
    for (size_t k = 0; k < sizeof properties / sizeof *properties; k++) {
        char *value = declared(declarations, properties[k]);
        any |= value != NULL;
        mem_free(value);
    }
    return any;
}

/* ---- Rules ---- */

static bool is_name(char c)
{
    return (c >= '0' && c <= '9') || ((c | 32) >= 'a' && (c | 32) <= 'z') || c == '-' || c == '_' || c < 0;
}

/* Of tag.class#id: a hundred for each id, ten for each class, one for the tag; -1: it is another kind. */
static int weight_of(const char *selector)
{
    int weight = 0;
    const char *at = selector + (*selector == '*');
    for (bool first = true; *at; first = false) {
        char kind = *at;
        if (kind == '.' || kind == '#')
            at++;
        else if (!first || at > selector)
            return -1;
        if (!is_name(*at)) return -1;
        while (is_name(*at)) at++;
        weight += kind == '#' ? 100 : kind == '.' ? 10 : 1;
    }
    return *selector ? weight : -1;
}

static bool add_rule(Reader *r, const char *selector, size_t length, const char *declarations)
{
    SvgTree *tree = r->tree;
    size_t count = (size_t)tree->rule_count;
    char *one = copy(selector, length);
    int weight = weight_of(one);
    if (weight < 0) {
        error_set(r->err, "the style's selector '%.60s' is not read: only tags, .classes and #ids are", one);
        mem_free(one);
        return false;
    }
    if (count == tree->rule_room) {
        tree->rule_room = 2 * count + 16;
        tree->rules = mem_resize(tree->rules, count, tree->rule_room, sizeof *tree->rules);
    }
    tree->rules[tree->rule_count++] = (SvgRule){one, mem_text(declarations), weight};
    return true;
}

/* The rule of a list of selectors. */
static bool add_rules(Reader *r, const char *selectors, size_t length, const char *declarations)
{
    bool ok = true;
    for (size_t part; ok && matters(declarations); selectors += part + 1, length -= part + 1) {
        const char *comma = memchr(selectors, ',', length);
        part = comma ? (size_t)(comma - selectors) : length;
        ok = add_rule(r, selectors, part, declarations);
        if (!comma) break;
    }
    return ok;
}

static void blank_comments(char *text)
{
    for (char *at; (at = strstr(text, "/*"));) {
        char *end = strstr(at + 2, "*/");
        size_t length = end ? (size_t)(end + 2 - at) : strlen(at);
        memset(at, ' ', length);
    }
}

/* The end of a block of braces, behind its '}', or of the text. */
static char *block_end(char *open)
{
    int depth = 0;
    for (char *at = open; *at; at++) {
        depth += (*at == '{') - (*at == '}');
        if (*at == '}' && depth <= 0) return at + 1;
    }
    return open + strlen(open);
}

/* A style sheet. Rules within @media and the like are no rules of ours. */
static bool read_sheet(Reader *r, char *text)
{
    bool ok = true;
    blank_comments(text);
    for (char *at = text, *end; ok && *at; at = end) {
        size_t head = strcspn(at, "{;");
        const char *start = at;
        size_t length = trim(&start, head);
        end = at[head] == '{' ? block_end(at + head) : at + head + (at[head] == ';');
        if (at[head] != '{') continue;
        char *block = mem_format("%.*s", (int)(end - at - (long)head - 1), at + head + 1), *brace;
        bool nested = *start == '@';
        for (brace = block; (brace = strpbrk(brace, nested ? "{}" : "}"));) *brace = ';';
        if (!nested)
            ok = add_rules(r, start, length, block);
        else if (matters(block))
            ok = error_set(r->err, "the style's rule '%.*s' is not read: it moves or hides something",
                           (int)(length < 60 ? length : 60), start);
        mem_free(block);
    }
    return ok;
}

/* ---- The tree ---- */

static void stop(Reader *r)
{
    error_prefix(r->err, "%s:%lu", r->path, (unsigned long)XML_GetCurrentLineNumber(r->parser));
    r->ok = false;
    XML_StopParser(r->parser, XML_FALSE);
}

static void begin_element(void *self, const char *name, const char **attributes)
{
    Reader *r = self;
    size_t count = 0;
    if (!r->ok) return;
    if (++r->depth > DEPTH_MOST) {
        error_set(r->err, "more than %d levels", DEPTH_MOST);
        stop(r);
        return;
    }
    while (attributes[count]) count++;
    SvgNode *node = mem_alloc(1, sizeof *node), *parent = r->open;
    *node = (SvgNode){.name = mem_text(strncmp(name, "svg:", 4) ? name : name + 4),
                      .attributes = mem_alloc(count + 1, sizeof *node->attributes),
                      .line = (int)XML_GetCurrentLineNumber(r->parser),
                      .parent = parent};
    for (size_t i = 0; i < count; i++) node->attributes[i] = mem_text(attributes[i]);
    if (!parent)
        r->tree->root = node;
    else if (parent->last)
        parent->last = parent->last->next = node;
    else
        parent->first = parent->last = node;
    r->open = node;
}

static void end_element(void *self, const char *name)
{
    Reader *r = self;
    (void)name;
    if (!r->ok) return;
    if (!strcmp(r->open->name, "style") && r->style.text) {
        if (!read_sheet(r, r->style.text)) stop(r);
        mem_free(r->style.text);
        r->style = (Text){0};
    }
    r->open = r->open->parent;
    r->depth--;
}

static void read_text(void *self, const char *text, int length)
{
    Reader *r = self;
    if (r->ok && r->open && !strcmp(r->open->name, "style")) text_add(&r->style, "%.*s", length, text);
}

/* ---- Identities ---- */

static int by_id(const void *a, const void *b)
{
    return strcmp((*(SvgNode *const *)a)->id, (*(SvgNode *const *)b)->id);
}

/* The next node of the tree, from above. */
static SvgNode *after(SvgNode *node)
{
    if (node->first) return node->first;
    while (node && !node->next) node = node->parent;
    return node ? node->next : NULL;
}

static void sort_names(SvgTree *tree)
{
    size_t count = 0;
    for (SvgNode *node = tree->root; node; node = after(node))
        count += (node->id = svg_attribute(node, "id")) != NULL;
    tree->named = mem_alloc(count, sizeof *tree->named);
    for (SvgNode *node = tree->root; node; node = after(node))
        if (node->id) tree->named[tree->named_count++] = node;
    if (count) qsort(tree->named, count, sizeof *tree->named, by_id);
}

bool svg_tree_parse(const char *path, const char *text, size_t length, SvgTree *tree, Error *err)
{
    *tree = (SvgTree){0};
    Reader r = {.parser = XML_ParserCreate(NULL), .tree = tree, .path = path, .err = err, .ok = true};
    enum XML_Status status = XML_STATUS_OK;
    if (!r.parser) mem_exhausted("Expat");
    XML_SetUserData(r.parser, &r);
    XML_SetElementHandler(r.parser, begin_element, end_element);
    XML_SetCharacterDataHandler(r.parser, read_text);
    for (size_t at = 0; status == XML_STATUS_OK && at <= length; at += CHUNK) {
        size_t left = length - at, part = left < CHUNK ? left : CHUNK;
        status = XML_Parse(r.parser, text + at, (int)part, left <= CHUNK);
        if (left <= CHUNK) break;
    }
    if (XML_GetErrorCode(r.parser) == XML_ERROR_NO_MEMORY) mem_exhausted("Expat");
    if (r.ok && status != XML_STATUS_OK) {
        error_set(err, "%s", XML_ErrorString(XML_GetErrorCode(r.parser)));
        stop(&r);
    }
    XML_ParserFree(r.parser);
    mem_free(r.style.text);
    if (r.ok)
        sort_names(tree);
    else
        svg_tree_clear(tree);
    return r.ok;
}

static void clear_node(SvgNode *node)
{
    for (SvgNode *child = node->first, *next; child; child = next) {
        next = child->next;
        clear_node(child);
    }
    for (char **a = node->attributes; *a; a++) mem_free(*a);
    mem_free(node->attributes);
    mem_free(node->name);
    mem_free(node);
}

void svg_tree_clear(SvgTree *tree)
{
    if (tree->root) clear_node(tree->root);
    for (int k = 0; k < tree->rule_count; k++) {
        mem_free(tree->rules[k].selector);
        mem_free(tree->rules[k].declarations);
    }
    mem_free(tree->rules);
    mem_free(tree->named);
    *tree = (SvgTree){0};
}

/* ---- Looking up ---- */

const char *svg_attribute(const SvgNode *node, const char *name)
{
    for (char **a = node->attributes; *a; a += 2)
        if (!strcmp(a[0], name)) return a[1];
    return NULL;
}

const SvgNode *svg_by_id(const SvgTree *tree, const char *id)
{
    const SvgNode key = {.id = id}, *wanted = &key;
    const SvgNode **found =
        bsearch(&wanted, tree->named, (size_t)tree->named_count, sizeof *tree->named, by_id);
    return found ? *found : NULL;
}

/* Is the word one of those in the list? */
static bool has_word(const char *list, const char *word, size_t length)
{
    for (size_t size; list && *list; list += size) {
        list += strspn(list, blanks);
        size = strcspn(list, blanks);
        if (size == length && !strncmp(list, word, size)) return true;
    }
    return false;
}

static bool matches(const char *selector, const SvgNode *node)
{
    for (const char *at = selector + (*selector == '*'), *end; *at; at = end) {
        char kind = *at;
        at += kind == '.' || kind == '#';
        for (end = at; is_name(*end);) end++;
        const char *own = kind == '.'   ? svg_attribute(node, "class")
                          : kind == '#' ? svg_attribute(node, "id")
                                        : node->name;
        if (!has_word(own, at, (size_t)(end - at))) return false;
    }
    return true;
}

char *svg_property(const SvgTree *tree, const SvgNode *node, const char *name)
{
    const char *style = svg_attribute(node, "style"), *attribute = svg_attribute(node, name);
    char *found = style ? declared(style, name) : NULL;
    if (found) return found;
    int heaviest = -1;
    for (int k = 0; k < tree->rule_count; k++) {
        const SvgRule *rule = &tree->rules[k];
        if (rule->weight < heaviest || !matches(rule->selector, node)) continue;
        char *value = declared(rule->declarations, name);
        if (!value) continue;
        mem_free(found);
        found = value, heaviest = rule->weight;
    }
    return found ? found : attribute ? copy(attribute, strlen(attribute)) : NULL;
}
