#include "shell/terms.h"

#define X(name) {#name, shell_##name##_term},
const ShellTermRow shell_term_rows[] = {SHELL_TERMS(X)};
#undef X

const int shell_term_row_count = (int)(sizeof shell_term_rows / sizeof *shell_term_rows);
