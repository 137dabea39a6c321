/* Who uses the library from C++ (and from C, examples/tutorial.c): tests/library.sh links both in each way that there is. */
#include <slender.h>
#include <stdio.h>
#include <string.h>

int main(void)
{
    char *versions = slender_versions();
    int ok = versions && strstr(versions, slender_version()) && strstr(versions, "CHOLMOD");
    if (!ok) fprintf(stderr, "slender %s says: %s\n", slender_version(), versions ? versions : "nothing");
    slender_free(versions);
    return ok ? 0 : 1;
}
