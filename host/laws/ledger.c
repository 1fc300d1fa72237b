#include "fields.h"
#include "laws.h"

#include <stdio.h>
#include <string.h>

static const field field_tangential_stored = {"tangential_stored", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "J",
                                              "energy of the tangential spring after the last step"};
static const field field_tangential_at = {"tangential_stiffness", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "N/m", "its stiffness then"};
static const field field_rolling_stored = {"rolling_stored", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "J",
                                           "energy of the rolling spring after the last step"};
static const field field_rolling_at = {"rolling_stiffness", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "N m", "its stiffness then"};

static const field field_half_gain = {"half_gain", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "m/s", "half of what the velocity gained in the last step"};
static const field field_half_turn = {"half_turn", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "rad/s", "half of what the spin gained in the last step"};

/* clang-format off */
#define DISSIPATION                                                                  \
    .slot = SLOT_DISSIPATION,                                                        \
    .doc = "What every contact dissipates in a step, from the forces that act.",     \
    .source = "docs/theory.md"
/* clang-format on */

const law law_dissipation_tracked = {
    .name = "tracked",
    DISSIPATION,
    .kernel_file = "effect/dissipation_ahead.cl",
    .more_files = {"effect/dissipation_tracked.cl"},
    .pair_fields = {&field_half_gain, &field_half_turn, &field_tangential_stored, &field_tangential_at, &field_rolling_stored, &field_rolling_at},
    .particle_fields = {&field_half_gain, &field_half_turn},
};

const law law_dissipation_synchronous = {
    .name = "tracked, velocities at the time of the forces",
    DISSIPATION,
    .kernel_file = "none/dissipation_ahead.cl",
    .more_files = {"effect/dissipation_tracked.cl"},
    .pair_fields = {&field_tangential_stored, &field_tangential_at, &field_rolling_stored, &field_rolling_at},
};

static const field field_record_energy = {"record_energy", PER_RECORD, FIELD_REAL, 5, FIELD_RESULT, "J",
                                          "of this step: dissipated normal, tangential, rolling; work of the wall, of changing stiffness"};
const field field_dissipated = {"dissipated", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "J", "dissipated normal, tangential, rolling"};
const field field_work_contacts = {"work_contacts", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "J", "work of walls, changing stiffness, expansion"};
const field field_work_grains = {"work_grains", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "J",
                                 "work of gravity; dissipated by background damping; work of prescribed motion"};

const law law_ledger_energies = {
    .name = "energies",
    .slot = SLOT_LEDGER,
    .doc = "What contacts and background damping dissipate, and the work of gravity, walls, prescribed groups and changing stiffness.",
    .source = "docs/theory.md",
    .kernel_file = "effect/ledger_energies.cl",
    .pair_fields = {&field_record_energy},
    .particle_fields = {&field_record_energy, &field_dissipated, &field_work_contacts, &field_work_grains},
};

static const field field_dissipation_heat = {"dissipation_heat", PER_RECORD, FIELD_REAL, 1, FIELD_RESULT, "J", "heat of this step for each grain of the contact"};

static void fraction_constant(const double *option, char *text, size_t size)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define DISSIPATION_FRACTION R(%#.17g)\n", option[0]);
}

const law law_fraction = {
    .name = "fraction",
    .slot = SLOT_DISSIPATION_HEAT,
    .doc = "A fraction of what contact damping, sliding and rolling dissipate heats the two grains, half each; at a wall all of it heats the grain.",
    .source = "docs/theory.md",
    .kernel_file = "effect/dissipation_heat_fraction.cl",
    .options = {{"fraction", NULL, 0, 1, 1, "share of the dissipated energy that becomes heat of the grains"}},
    .pair_fields = {&field_dissipation_heat},
    .particle_fields = {&field_dissipation_heat},
    .constants = fraction_constant,
};
