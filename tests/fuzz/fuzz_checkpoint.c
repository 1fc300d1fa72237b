/* Any file is a checkpoint or is refused with a message; what a checkpoint holds can be asked for. */
#include "bundle.h"
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    failure why = {""};
    bundle state;
    char path[64];
    int file = fuzz_file(data, size, path, sizeof path);
    bundle_init(&state);
    status result = bundle_read(path, &state, &why);
    FUZZ_HOLDS(result == STATUS_OK || (why.text[0] && result == STATUS_BAD_INPUT));
    for (int k = 0; result == STATUS_OK && k < state.count; k++) {
        const bundle_entry *entry;
        const bundle_entry *e = &state.entry[k];
        FUZZ_HOLDS(e->rows >= 0 && e->columns >= 0);
        (void)bundle_get(&state, path, e->name, BUNDLE_F64, -1, -1, &entry, &why);
    }
    bundle_free(&state);
    close(file);
    return 0;
}
