/* smoothness.h - objectives that need the shell's neighbours. */
#pragma once
#include "shell/shell.h"
#include "solve/objective.h"

/* sum over inner edges of |M_left - M_right|^2, (A/m)^2: small where a printer need not change its head's
 * field. Borrows the shell. */
Objective shell_magnetization_smoothness(const Shell *shell, double weight);
