#include "rod/terms.h"

#define X(name, form) {#name, rod_##name##_term, form},
const RodTermRow rod_term_rows[] = {ROD_TERMS(X)};
#undef X

const int rod_term_row_count = (int)(sizeof rod_term_rows / sizeof *rod_term_rows);
