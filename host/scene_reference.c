/* The scene reference: the parameter table, the law descriptors and the property rows as one Markdown page. */
#include "property.h"
#include "scene_table.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const type_names[] = {
    [PARAMETER_NUMBER] = "number",
    [PARAMETER_INTEGER] = "whole number",
    [PARAMETER_FLAG] = "true or false",
    [PARAMETER_CHOICE] = "word",
    [PARAMETER_TEXT] = "text",
    [PARAMETER_NAME] = "name",
    [PARAMETER_VECTOR] = "[x, y, z]",
    [PARAMETER_DIRECTION] = "[x, y, z], any length",
    [PARAMETER_COUNTS] = "three whole numbers",
    [PARAMETER_NUMBERS] = "list of numbers",
    [PARAMETER_WORDS] = "list of words",
    [PARAMETER_FLAGS] = "list of words",
    [PARAMETER_SECTION] = "mapping",
    [PARAMETER_LIST] = "list of mappings",
    [PARAMETER_OTHER] = "",
    [PARAMETER_LATER] = "",
};

/* A `|` would end a cell of the table. */
static void write_cell(FILE *page, const char *text)
{
    for (; text && *text; text++)
        if (*text == '|')
            fputs("\\|", page);
        else
            fputc(*text, page);
}

static void write_form(FILE *page, const parameter *row)
{
    char list[512], range[128];
    if (row->choices) {
        words_list(row->choices, list, sizeof list);
        fprintf(page, "%s%s", row->type == PARAMETER_FLAGS ? "list of " : "", list);
    } else {
        write_cell(page, row->form ? row->form : type_names[row->type]);
    }
    parameter_range(row, range, sizeof range);
    if (range[0])
        fprintf(page, ", %s", range);
    if (row->word)
        fprintf(page, ", or `%s`", row->word);
}

static void write_default(FILE *page, const parameter *row)
{
    if (row->required)
        fputs("required", page);
    else if (row->shown)
        write_cell(page, row->shown);
    else if (row->fallback && row->fallback[0])
        fprintf(page, "`%s`", row->fallback);
    else if (row->type == PARAMETER_SECTION)
        fputs("as below", page);
    else
        fputs("none", page);
}

static void write_row(FILE *page, const parameter *row, const char *selector)
{
    fprintf(page, "| `%s` | ", row->key);
    write_form(page, row);
    fprintf(page, " | %s | ", row->unit ? row->unit : "");
    write_default(page, row);
    fputs(" | ", page);
    if (row->only) {
        char list[256];
        words_list(row->only, list, sizeof list);
        fprintf(page, "(%s %s) ", selector, list);
    }
    write_cell(page, row->doc);
    fputs(" |\n", page);
}

static void begin_table(FILE *page)
{
    fputs("\n| Key | Value | Unit | Default | Meaning |\n| --- | --- | --- | --- | --- |\n", page);
}

static void write_properties(FILE *page, const property *const *all)
{
    for (const property *const *p = all; *p; p++) {
        parameter row = parameter_of_property(*p);
        char shown[64] = "needed where a law reads it";
        if (*p == &property_normal_damping)
            snprintf(shown, sizeof shown, "what `restitution` gives, else 0");
        else if (*p == &property_restitution)
            snprintf(shown, sizeof shown, "none");
        else if (*p == &property_bond_shear_modulus)
            snprintf(shown, sizeof shown, "0.4 of bond_youngs_modulus_pa");
        else if ((*p)->fallback_property)
            snprintf(shown, sizeof shown, "that of %s", (*p)->fallback_property->key);
        else if (!isnan((*p)->fallback))
            snprintf(shown, sizeof shown, "%.10g", (*p)->fallback);
        row.shown = shown;
        char doc[256];
        snprintf(doc, sizeof doc, "%s%s", row.doc, property_is_tabled(*p) ? "; a number, or a table against temperature" : "");
        row.doc = doc;
        write_row(page, &row, NULL);
    }
}

static void write_section(FILE *page, const char *title, const section *s)
{
    fprintf(page, "\n## %s\n\n%s\n", title, s->doc);
    begin_table(page);
    for (const parameter *row = s->row; row->key; row++)
        if (row->type != PARAMETER_LATER)
            write_row(page, row, s->selector);
    if (s->properties)
        write_properties(page, s->properties());
}

static void write_needs(FILE *page, const char *what, const property *const *need)
{
    for (int k = 0; k < LAW_PROPERTIES_MAX && need[k]; k++)
        fprintf(page, "%s`%s`%s", k == 0 ? what : ", ", need[k]->key, k + 1 == LAW_PROPERTIES_MAX || !need[k + 1] ? ".\n" : "");
}

static void write_law(FILE *page, const law *l)
{
    fprintf(page, "\n### %s: `%s`\n\n%s Source: %s.\n", slot_name(l->slot), l->name, l->doc, l->source);
    write_needs(page, "Needs of every material: ", l->material_needs);
    write_needs(page, "Needs of every pair: ", l->interaction_needs);
    if (!l->options[0].key)
        return;
    begin_table(page);
    for (int k = 0; k < LAW_OPTIONS_MAX && l->options[k].key; k++) {
        const law_option *option = &l->options[k];
        char shown[64];
        snprintf(shown, sizeof shown, "`%.10g`", option->fallback);
        if (!option->choices && isnan(option->fallback))
            snprintf(shown, sizeof shown, "required");
        if (option->choices)
            snprintf(shown, sizeof shown, "`%.*s`", (int)strcspn(option->choices, "|"), option->choices);
        const parameter row = {.key = option->key,
                               .type = option->choices ? PARAMETER_CHOICE : PARAMETER_NUMBER,
                               .low = option->low,
                               .high = option->high,
                               .choices = option->choices,
                               .doc = option->doc,
                               .shown = shown,
                               .unit = parameter_unit(option->key)};
        write_row(page, &row, NULL);
    }
}

static void write_outputs(FILE *page, const char *title, const output_name *known)
{
    fprintf(page, "\n### %s\n\n| Name | Unit | Components | Meaning |\n| --- | --- | --- | --- |\n", title);
    for (; known->name; known++)
        if (!known->needs)
            fprintf(page, "| `%s` | %s | %d | %s |\n", known->name, known->unit, known->components, known->doc);
}

static void write_page(FILE *page)
{
    fputs("# Scene reference\n\nGenerated from the parameter table; do not edit. A scene is one YAML document. All numbers are in SI and "
          "stand "
          "alone, without a unit. Unknown keys are errors.\n\n`--set path=value` changes any key from the command line: "
          "`--set walls[floor].point_m=[0,0,1]`, `--set effects[tangential].shear_modulus=mindlin`, `--set "
          "interactions[default].restitution=0.3`, "
          "`--set interactions[steel,floor].friction_static=0.1`, `--set particles[0].items[2].radius_m=1e-3`. Entries of lists go by name "
          "(effects by slot, interactions by what they are between) or by index, counted from 0.\n",
          page);
    write_section(page, "Scene", &scene_section);
    write_section(page, "`domain`", &domain_section);
    write_section(page, "`environment`", &environment_section);
    write_section(page, "`gas`", &gas_section);
    write_section(page, "Values that are tables", &quantity_section);
    write_section(page, "Tables against temperature", &property_table_section);
    write_section(page, "`effects`", &effect_section);
    for (const law *const *l = laws; *l; l++)
        write_law(page, *l);
    write_section(page, "`materials`", &material_section);
    write_section(page, "`walls`", &wall_section);
    write_section(page, "`servo`", &servo_section);
    write_section(page, "`wall_groups`", &wall_group_section);
    write_section(page, "`interactions`", &interaction_section);
    write_section(page, "`particles`", &group_section);
    write_section(page, "`items` of a list", &item_section);
    write_section(page, "`region`", &region_section);
    write_section(page, "`radius_m` as a distribution", &radius_section);
    write_section(page, "`motion`", &motion_section);
    write_section(page, "`stages`", &stage_section);
    write_section(page, "`until`", &until_section);
    write_section(page, "`heat` of a stage", &stage_heat_section);
    write_section(page, "`repeat` of a stage", &stage_repeat_section);
    write_section(page, "`change`", &change_section);
    write_section(page, "`walls` of a change", &wall_change_section);
    write_section(page, "`wall_groups` of a change", &wall_group_change_section);
    write_section(page, "`particles` of a change", &group_change_section);
    write_section(page, "`output`", &output_section);
    write_outputs(page, "Fields", output_fields);
    write_outputs(page, "Observables", output_observables);
    write_section(page, "`contact_table`", &table_section);
    write_section(page, "`guards`", &guard_section);
    write_section(page, "`study`", &study_section);
    write_section(page, "`closed_form` of a study", &closed_form_section);
}

char *scene_reference(void)
{
    char *text = NULL;
    size_t size = 0;
    FILE *page = open_memstream(&text, &size);
    if (!page)
        return NULL;
    write_page(page);
    fclose(page);
    return text;
}
