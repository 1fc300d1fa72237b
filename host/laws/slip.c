#include "../property.h"
#include "laws.h"

static void derive_slip(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    parameter[0] = interaction_constant(class, &property_friction_static);
    parameter[1] = interaction_constant(class, &property_friction_dynamic);
}

static void derive_slip_single(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    parameter[0] = interaction_constant(class, &property_friction_static);
}

const law law_slip_single = {
    .name = "single",
    .slot = SLOT_SLIP,
    .doc = "One friction coefficient.",
    .source = "TM Eq. 8",
    .kernel_file = "effect/slip_single.cl",
    .parameters = {"FRICTION_STATIC"},
    .derive = derive_slip_single,
};

static const field field_sliding = {"sliding", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "", "1 while the contact slides"};

const law law_slip_two = {
    .name = "static_and_dynamic",
    .slot = SLOT_SLIP,
    .doc = "Static and dynamic friction: a sliding contact sticks again only below the dynamic limit.",
    .source = "TM Eq. 8 with a sliding flag per contact (docs/theory.md)",
    .kernel_file = "effect/slip_static_and_dynamic.cl",
    .pair_fields = {&field_sliding},
    .parameters = {"FRICTION_STATIC", "FRICTION_DYNAMIC"},
    .derive = derive_slip,
};
