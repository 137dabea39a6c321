#include "solid/terms.h"

#define X(name) {#name, solid_##name##_term},
const SolidTermRow solid_term_rows[] = {SOLID_TERMS(X)};
#undef X

const int solid_term_row_count = (int)(sizeof solid_term_rows / sizeof *solid_term_rows);
