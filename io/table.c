#include "io/table.h"
#include "base/memory.h"
#include "io/safe_file.h"
#include "io/scan.h"
#include "io/text.h"
#include <string.h>
#include <strings.h>

/* What the rows of one file have in common, and room for their numbers. */
typedef struct Reader {
    Scan scan;
    Table *table;
    size_t values, rows; /* that fit before the arrays grow                                     */
    const char *names;   /* of the columns; NULL: any                                           */
    char separator;      /* 0: the first row is still to come; ' ': blanks                      */
    char decimal;        /* 0: all numbers so far are whole                                     */
    bool commas;         /* may be decimal                                                      */
} Reader;

/* ---- Cells ---- */

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_letter(char c)
{
    return (c | 32) >= 'a' && (c | 32) <= 'z';
}

/* Is every comma of the row between two digits? */
static bool commas_are_decimal(const char *at, const char *end)
{
    bool any = false;
    for (const char *c = at; c < end; c++) {
        if (*c != ',') continue;
        if (c == at || c + 1 == end || !is_digit(c[-1]) || !is_digit(c[1])) return false;
        any = true;
    }
    return any;
}

/* How the row that is being scanned is split. */
static void choose_separator(Reader *r)
{
    const char *at = r->scan.at, *end = r->scan.word_end;
    size_t length = (size_t)(end - at);
    if (memchr(at, ';', length))
        r->separator = ';';
    else if (memchr(at, '\t', length) && commas_are_decimal(at, end))
        r->separator = '\t';
    else
        r->separator = memchr(at, ',', length) ? ',' : ' ';
    r->commas = r->separator != ',' && r->separator != ' ';
}

/* The next cell of the row without the blanks around it; what follows the row's last separator is none. */
static bool next_cell(Reader *r, Word *cell)
{
    Scan *scan = &r->scan;
    if (r->separator == ' ') return scan_word(scan, cell);
    if (!scan_more(scan)) return false;
    const char *end = memchr(scan->at, r->separator, (size_t)(scan->word_end - scan->at)), *at = scan->at;
    scan->at = end ? end + 1 : scan->word_end;
    while (scan_more(scan) && scan_is_blank(*scan->at) && *scan->at != r->separator) scan->at++;
    if (!end) end = scan->word_end;
    while (end > at && scan_is_blank(end[-1])) end--;
    *cell = (Word){at, (int)(end - at)};
    return true;
}

/* A cell with a decimal point, or with a decimal comma where the file has these. */
static bool cell_number(Reader *r, Word cell, double *value)
{
    char text[64], *comma, kind = memchr(cell.text, '.', (size_t)cell.length) ? '.' : 0;
    if (cell.length >= (int)sizeof text) return false;
    memcpy(text, cell.text, (size_t)cell.length);
    text[cell.length] = 0;
    if (r->commas && (comma = strchr(text, ','))) {
        if (kind) return false;
        kind = ',', *comma = '.';
    }
    if (!word_number((Word){text, cell.length}, value) || (kind && r->decimal && kind != r->decimal))
        return false;
    if (kind) r->decimal = kind;
    return true;
}

/* ---- The header ---- */

/* A row whose cells are words; "nan" and "inf" are no words but bad numbers. Leaves the row unread. */
static bool is_header(Reader *r)
{
    Scan before = r->scan;
    Word cell;
    double value;
    bool words = true;
    for (int k = 0; words && next_cell(r, &cell); k++) {
        char c = cell.length ? cell.text[0] : 0;
        words = k == 0 ? (is_letter(c) || c == '"' || c == '\'' || c == '_' || c < 0) &&
                             !word_begins(cell, "nan") && !word_begins(cell, "inf")
                       : !cell_number(r, cell, &value);
    }
    r->scan = before;
    return words;
}

/* The row that is being scanned. The next one decides how numbers are split: a title may have commas. */
static void keep_header(Reader *r)
{
    r->table->header = mem_format("%.*s", (int)(r->scan.word_end - r->scan.at), r->scan.at);
    r->table->header_line = r->scan.line;
    r->separator = 0;
}

/* The last comment before the first row, which is being scanned: a header that others write as one. */
static void keep_note(Reader *r, const char *text)
{
    const char *end = r->scan.start, *start;
    int line = r->scan.line;
    for (; end > text; end = start) {
        for (start = end - 1; start > text && start[-1] != '\n';) start--;
        const char *c = start + strspn(start, " \t");
        line--;
        if (*c != '#') continue;
        c += strspn(c, "# \t");
        r->table->note = mem_format("%.*s", (int)strcspn(c, "\r\n"), c);
        r->table->header_line = line;
        return;
    }
}

/* ---- Rows ---- */

static bool refuse_cell(const Reader *r, Word cell)
{
    if (cell.length == 0) return scan_refuse(&r->scan, "there is nothing between two separators");
    bool differs = r->commas && r->decimal;
    for (int i = 0; i < cell.length; i++) differs &= cell.text[i] && strchr("0123456789+-.,eE", cell.text[i]);
    return scan_refuse(&r->scan, "'%.*s' is no finite number%s", cell.length > 40 ? 40 : cell.length,
                       cell.text,
                       !differs            ? ""
                       : r->decimal == ',' ? " with a decimal comma, as those before it"
                                           : " with a decimal point, as those before it");
}

static void keep_value(Reader *r, int column, double value)
{
    Table *table = r->table;
    size_t place = (size_t)table->rows * (size_t)table->columns + (size_t)column;
    if (place >= r->values) {
        table->values = mem_resize(table->values, r->values, 2 * place + 64, sizeof *table->values);
        r->values = 2 * place + 64;
    }
    table->values[place] = value;
}

/* Appends the line's numbers. */
static bool read_row(Reader *r)
{
    Table *table = r->table;
    int columns = 0;
    if (!r->separator) choose_separator(r);
    if (table->rows == 0 && !table->header && is_header(r)) {
        keep_header(r);
        return true;
    }
    for (Word cell; next_cell(r, &cell); columns++) {
        double value;
        if (!cell_number(r, cell, &value)) return refuse_cell(r, cell);
        keep_value(r, columns, value);
    }
    if (table->columns == 0) table->columns = columns;
    if (columns != table->columns)
        return scan_refuse(&r->scan, "%d number%s in this row, and %d are needed%s%s", columns,
                           columns == 1 ? "" : "s", table->columns, r->names ? ": " : "",
                           r->names ? r->names : "");
    size_t rows = (size_t)table->rows;
    if (rows == r->rows) {
        table->line = mem_resize(table->line, rows, 2 * rows + 64, sizeof *table->line);
        r->rows = 2 * rows + 64;
    }
    table->line[table->rows++] = r->scan.line;
    return true;
}

static int count_names(const char *names)
{
    int count = names && *names;
    for (; names && *names; names++) count += *names == ',';
    return count;
}

bool table_parse(const char *path, const char *text, long length, const char *names, Table *table, Error *err)
{
    size_t left = (size_t)length;
    *table = (Table){.columns = count_names(names)};
    bool ok = scan_skip_mark(path, &text, &left, err);
    Reader r = {.scan = scan_start(path, text, left, '#', "", err), .table = table, .names = names};
    ok = ok && scan_check_text(&r.scan);
    for (bool first = true; ok && scan_line(&r.scan); first = false) {
        if (first) keep_note(&r, text);
        ok = read_row(&r);
    }
    if (ok && table->rows == 0) ok = error_set(err, "%s: there are no numbers in it", path);
    if (ok && names) ok = table_take_header(table, path, names, err);
    if (!ok) table_clear(table);
    return ok;
}

bool table_read(const char *path, const char *names, Table *table, Error *err)
{
    char *text;
    size_t length;
    *table = (Table){0};
    if (!scan_file(path, &text, &length, err)) return false;
    bool ok = table_parse(path, text, (long)length, names, table, err);
    mem_free(text);
    return ok;
}

bool table_check_increasing(const Table *table, const char *path, const char *name, Error *err)
{
    for (int row = 1; row < table->rows; row++) {
        double before = table->values[(size_t)table->columns * (size_t)(row - 1)],
               now = table->values[(size_t)table->columns * (size_t)row];
        if (!(now > before))
            return error_set(err, "%s:%d: %s is %g here and %g in the row before: it must increase", path,
                             table->line[row], name, now, before);
    }
    return true;
}

bool table_write(const char *path, const char *header, const double *values, int rows, int columns,
                 Error *err)
{
    Text text = {0};
    if (header) text_add(&text, "%s\n", header);
    for (long i = 0; i < (long)rows * columns; i++)
        text_add(&text, "%.17g%s", values[i], (i + 1) % columns ? ", " : "\n");
    bool ok = safe_file_write(path, text.text ? text.text : "", text.length, false, err);
    mem_free(text.text);
    return ok;
}

void table_clear(Table *table)
{
    mem_free(table->values);
    mem_free(table->line);
    mem_free(table->header);
    mem_free(table->note);
    *table = (Table){0};
}
