#include "tuning.h"

#include "cache.h"

#include <clast/shared.h>
#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define CACHE_VERSION 2 /* counts on when what was measured holds no longer */

/* By measurement (docs/performance.md); the loop on a GPU is a guess. */
tuning tuning_default(const device_info *info)
{
    return (tuning){
        .block = CLAST_BLOCK, .batch_steps = 64, .chunk_records = info->cpu ? 32768 : 0, .loop_records = info->cpu ? 500 : 1000};
}

/* FNV-1a, 64 bits. */
static uint64_t hash_text(uint64_t hash, const char *text)
{
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        hash = (hash ^ *c) * 1099511628211u;
    return (hash ^ 0xffu) * 1099511628211u;
}

static bool file_of(const device_info *info, char *path, size_t size)
{
    const char *const parts[] = {info->platform_name, info->vendor, info->name, info->driver, info->version};
    uint64_t hash = 14695981039346656037u ^ info->compute_units;
    char directory[3072];
    if (!cache_directory(directory, sizeof directory))
        return false;
    for (size_t p = 0; p < sizeof parts / sizeof *parts; p++)
        hash = hash_text(hash, parts[p]);
    snprintf(path, size, "%s/tuning-%d-%016llx.json", directory, CACHE_VERSION, (unsigned long long)hash);
    return true;
}

static bool is_power_of_two(int n)
{
    return n > 0 && (n & (n - 1)) == 0;
}

static bool makes_sense(const tuning *t)
{
    return is_power_of_two(t->block) && t->block >= 16 && t->block <= 1024 && t->batch_steps >= 1 && t->batch_steps <= 1024 &&
           t->loop_records >= 0 && t->loop_records <= 1000000 &&
           (t->chunk_records == 0 || (is_power_of_two(t->chunk_records) && t->chunk_records >= t->block));
}

tuning tuning_load(const device_info *info)
{
    tuning found = tuning_default(info), fallback = found;
    const char *switched = getenv("CLAST_TUNING");
    char path[4096];
    if ((switched && strcmp(switched, "off") == 0) || !file_of(info, path, sizeof path))
        return fallback;
    json_t *root = json_load_file(path, 0, NULL);
    bool read = root && json_unpack(root, "{s:i, s:i, s:i, s:i}", "block", &found.block, "batch_steps", &found.batch_steps, "chunk_records",
                                    &found.chunk_records, "loop_records", &found.loop_records) == 0;
    json_decref(root);
    found.measured = true;
    return read && makes_sense(&found) ? found : fallback;
}

status tuning_store(const device_info *info, const tuning *of, char *path, size_t size, failure *why)
{
    char temporary[4200];
    if (!file_of(info, path, size))
        return fail(why, STATUS_ERROR, "there is no folder to keep the tuning in; set XDG_CACHE_HOME or HOME");
    snprintf(temporary, sizeof temporary, "%s.%ld", path, (long)getpid());
    json_t *root = json_pack("{s:s, s:i, s:i, s:i, s:i}", "device", info->name, "block", of->block, "batch_steps", of->batch_steps,
                             "chunk_records", of->chunk_records, "loop_records", of->loop_records);
    bool kept = root && json_dump_file(root, temporary, JSON_INDENT(1)) == 0 && rename(temporary, path) == 0;
    json_decref(root);
    return kept ? STATUS_OK : fail(why, STATUS_ERROR, "%s: cannot be written: %s", path, strerror(errno));
}

status tuning_forget(const device_info *info, char *path, size_t size, failure *why)
{
    if (file_of(info, path, size) && unlink(path) != 0 && errno != ENOENT)
        return fail(why, STATUS_ERROR, "%s: cannot be removed: %s", path, strerror(errno));
    return STATUS_OK;
}
