/* rigid.h - rigid motions that nothing holds: how many there are, and whether a dead force drives one away.
 */
#pragma once
#include "base/error.h"
#include "shell/shell.h"

/* Rigid motions of all connected parts (six each) that held coordinates and slopes leave free. A field may
 * hold some of them; statics then still needs a base shift (system.h) to tell a minimum from a neutral state.
 */
int rigid_free_count(const Shell *shell);

/* False and a sentence where weight and loads in p push a part along an axis on which nothing holds it: such
 * a body has no equilibrium. */
bool rigid_check_force(const Shell *shell, const double *p, Error *err);
