/* Clusters: grains that bonds join, directly or through others (walls join nobody). Found on the host from the records, when an output asks. */
#include "laws/fields.h"
#include "simulation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The root of a tree of grains; the way there is halved. */
static int32_t root_of(int32_t *parent, int32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/* The smaller id becomes the root, so that a cluster bears the smallest of its grains', whatever the order of the records. */
static void join(int32_t *parent, int32_t a, int32_t b)
{
    int32_t p = root_of(parent, a), q = root_of(parent, b);
    if (p < q)
        parent[q] = p;
    else
        parent[p] = q;
}

static status read_ints(simulation *sim, cl_mem mem, int64_t count, int32_t **out, failure *why)
{
    *out = malloc(sizeof **out * (size_t)(count + 1));
    if (!*out)
        return fail(why, STATUS_ERROR, "out of memory");
    return store_read(sim, mem, 0, 4 * (uint64_t)count, *out, why);
}

typedef struct bond_records {
    int32_t *owner, *other, *id;
    double *bonded;
} bond_records;

static status read_bonds(simulation *sim, bond_records *r, failure *why)
{
    const contact_table *t = &sim->table;
    TRY(read_ints(sim, t->owner[t->now], t->pair_count, &r->owner, why));
    TRY(read_ints(sim, t->other[t->now], t->pair_count, &r->other, why));
    if (!(r->bonded = malloc(sizeof *r->bonded * (size_t)(t->pair_count + 1))))
        return fail(why, STATUS_ERROR, "out of memory");
    return store_get(sim, store_find(sim, field_bonded.name)->mem, FIELD_REAL, 0, t->pair_count, r->bonded, why);
}

static void join_records(const simulation *sim, const bond_records *r, int32_t *parent)
{
    for (int64_t i = 0; i < sim->id_count; i++)
        parent[i] = -1;
    for (int64_t i = 0; i < sim->count; i++)
        parent[r->id[i]] = r->id[i];
    for (int64_t k = 0; r->bonded && k < sim->table.pair_count; k++)
        if (llround(fabs(r->bonded[k])) % 2 == 1)
            join(parent, r->id[r->owner[k]], r->id[r->other[k]]);
    for (int64_t i = 0; i < sim->id_count; i++)
        if (parent[i] >= 0)
            parent[i] = root_of(parent, (int32_t)i);
}

status clusters_find(simulation *sim, int32_t **out, failure *why)
{
    bond_records r = {NULL, NULL, NULL, NULL};
    *out = malloc(sizeof **out * (size_t)(sim->id_count + 1));
    status result = *out ? read_ints(sim, store_find(sim, "id")->mem, sim->stride, &r.id, why) : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK && sim->live.law[SLOT_BOND] && sim->table.built)
        result = read_bonds(sim, &r, why);
    if (result == STATUS_OK)
        join_records(sim, &r, *out);
    free(r.owner);
    free(r.other);
    free(r.id);
    free(r.bonded);
    return result;
}

/* 1, 2, 3 to 4, 5 to 8, ...: the last class has all that is larger. */
static int size_class(int64_t size)
{
    int class = 0;
    while (class < CLUSTER_CLASSES - 1 && ((int64_t)1 << class) < size)
        class++;
    return class;
}

status clusters_measure(simulation *sim, cluster_sums *out, failure *why)
{
    int32_t *cluster = NULL;
    memset(out, 0, sizeof *out);
    int64_t *size = calloc((size_t)sim->id_count + 1, sizeof *size);
    status result = size ? clusters_find(sim, &cluster, why) : fail(why, STATUS_ERROR, "out of memory");
    for (int64_t i = 0; i < sim->id_count && result == STATUS_OK; i++)
        if (cluster[i] >= 0)
            size[cluster[i]]++;
    for (int64_t i = 0; i < sim->id_count && result == STATUS_OK; i++) {
        if (size[i] == 0)
            continue;
        out->sizes[size_class(size[i])] += 1.0;
        out->count += size[i] > 1;
        out->grains += size[i] > 1 ? size[i] : 0;
        out->largest = size[i] > out->largest ? size[i] : out->largest;
    }
    free(size);
    free(cluster);
    return result;
}
