/* libFuzzer: scene files. What loads must come back from its effective scene unchanged. */
#include "base/memory.h"
#include "model/scene.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    Scene scene, again;
    YamlFile *file = yaml_parse("fuzz.yaml", (const char *)bytes, size);
    yaml_override(file, "shell.mesh.n=7");
    if (yaml_load(file, scene_table(), &scene)) {
        char *text = yaml_write(scene_table(), &scene);
        YamlFile *effective = yaml_parse("fuzz.yaml", text, strlen(text));
        if (!yaml_load(effective, scene_table(), &again)) abort();
        char *text_again = yaml_write(scene_table(), &again);
        if (strcmp(text, text_again)) abort();
        mem_free(text);
        mem_free(text_again);
        yaml_clear(scene_table(), &again);
        yaml_destroy(effective);
    }
    char *report = yaml_report(file);
    mem_free(report);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    if (mem_live_count()) abort();
    return 0;
}
