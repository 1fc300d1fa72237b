/* Any text is a scene or is refused with a message. A scene that was read is written out again, and that reads as well. */
#include "fuzz.h"
#include "scene.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    failure why = {""};
    scene *read = NULL, *again = NULL;
    char *text = fuzz_text(data, size);
    status result = scene_read_text(text, "fuzz.yaml", 0, NULL, &read, &why);
    FUZZ_HOLDS((result == STATUS_OK) == (read != NULL));
    FUZZ_HOLDS(result == STATUS_OK || why.text[0]);
    FUZZ_HOLDS(result == STATUS_OK || result == STATUS_BAD_INPUT);
    if (read) {
        result = scene_read_text(read->text, "again.yaml", 0, NULL, &again, &why);
        if (result != STATUS_OK)
            fuzz_say("what was read does not read again: %s\n", why.text);
        FUZZ_HOLDS(result == STATUS_OK);
    }
    scene_free(read);
    scene_free(again);
    free(text);
    return 0;
}
