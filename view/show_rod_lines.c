#include "view/show_rod_lines.h"
#include <string.h>

enum { LINE_LENGTH = 110 };

typedef struct Print {
    ShowData *data;
    RodLines lines;
} Print;

/* Adds to the last line, or begins another one where that is full. */
static void add_text(Print *print, const char *text)
{
    if (print->lines.count > 0) {
        const char *last = print->lines.text[print->lines.count - 1];
        if (strlen(last) + strlen(text) < LINE_LENGTH) {
            print->lines.text[print->lines.count - 1] = show_text(print->data, "%s, %s", last, text);
            return;
        }
    }
    if (print->lines.count < ROD_LINES_MAX)
        print->lines.text[print->lines.count++] = show_text(print->data, "%s", text);
}

RodLines show_rod_lines(const ShowCurves *curves)
{
    Print whole = {.data = curves->data}, *print = &whole;
    const ShowFact *facts;
    Array status;
    if (result_read(print->data->result, "slender/status", &status, NULL)) {
        add_text(print, status.data);
        array_clear(&status);
    }
    if (curves->strand_count > 1)
        add_text(print,
                 show_text(print->data, "%d strands, %d points", curves->strand_count, curves->point_count));
    else
        add_text(print, show_text(print->data, "%d elements", curves->point_count - 1));
    int count = show_curves_facts(curves, &facts);
    for (int k = 0; k < count; k++)
        add_text(print, facts[k].name ? show_text(print->data, "%s %s", facts[k].name, facts[k].value)
                                      : facts[k].value);
    return print->lines;
}
