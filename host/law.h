/* A law is one effect on the particles, described by one constant: its slot, its kernel file, the properties it reads, the fields it
 * stores, its options. Everything else (scene keys, checks, kernel arguments, memory, reference pages) is read off these descriptors. */
#ifndef CLAST_HOST_LAW_H
#define CLAST_HOST_LAW_H
#include "status.h"

/* In the order in which the stages call them. Slots marked derived are chosen by the scene as a whole, not listed under `effects:`. */
typedef enum slot_id {
    SLOT_PRECISION,   /* derived: double, or float with what takes small increments kept whole */
    SLOT_TABLES,      /* derived: properties by temperature */
    SLOT_COMPOSITION, /* derived: one material or several */
    SLOT_DIMENSIONS,  /* derived: a plane instead of space */
    SLOT_PERIODIC,    /* derived: nearest image */
    SLOT_MOTION,      /* derived: all free, or groups with prescribed motion */
    SLOT_ROTATION,    /* derived: spin, where a law or an output asks for it */
    SLOT_TEMPERATURE, /* derived: temperature and its step, where a thermal law or an output asks for them */
    SLOT_SUBSTANCE,   /* derived: constants of the grains' materials, where several have a temperature */
    SLOT_CONDUCTIVITY, /* derived: conductivities that depend on temperature */
    SLOT_RADIUS,  /* radii that depend on temperature */
    SLOT_MODULUS, /* moduli that depend on temperature */
    SLOT_NORMAL,
    SLOT_BONDING, /* derived: what lets a contact bond */
    SLOT_BOND,
    SLOT_COHESION,
    SLOT_FRICTION, /* derived: friction coefficients that depend on temperature */
    SLOT_SLIP, /* derived: one friction coefficient, or static and dynamic with the sliding flag */
    SLOT_TANGENTIAL,
    SLOT_ROLLING,
    SLOT_SOFTENING,   /* derived: work of changing moduli, where the ledger is live */
    SLOT_EXPANSION,   /* derived: work of growing radii, where the ledger is live */
    SLOT_DISSIPATION, /* derived: what contacts dissipate, where the ledger or heat asks */
    SLOT_DISSIPATION_HEAT,
    SLOT_LEDGER, /* derived: energies, where an observable asks for them */
    SLOT_CONDUCTION,
    SLOT_WALLS,     /* derived: the shapes present */
    SLOT_WALL_HEAT, /* derived: walls that are not adiabatic */
    SLOT_BODY,
    SLOT_ENVIRONMENT, /* derived: temperature and motion of what surrounds the bed, where a law reads them */
    SLOT_CONVECTION,
    SLOT_RADIATION,
    SLOT_SOURCE,
    SLOT_HEAT_GENERATION,
    SLOT_HEAT_STEPS,     /* derived: heat in every n-th step only */
    SLOT_THERMAL_GROUPS, /* derived: grains of prescribed temperature, or heated by a given flux */
    SLOT_HEAT_TALLY,     /* derived: heat by path, where an observable asks for it */
    SLOT_ORIENTATION, /* derived: quaternions, where an output asks for them */
    SLOT_INTEGRATOR,
    SLOT_PACKED, /* derived: what pairs read of a grain once more in one line of a cache */
    SLOT_TOUCHED, /* derived: which grains of a loose bed may have a contact in this step */
    SLOT_COUNT
} slot_id;

/* A number that a material or an interaction carries. Laws share rows by pointing at the same constant. */
typedef struct property {
    const char *key;  /* scene key, with its unit */
    double low, high; /* allowed range, both ends included unless open_low */
    bool open_low;    /* low itself is not allowed */
    double fallback;  /* used when absent; NAN: a live law that needs it fails */
    const struct property *fallback_property; /* taken instead when absent (rolling damping -> normal damping); or NULL */
    const char *doc;
} property;

/* A number or a choice in an entry of `effects:`. Stored as a double; a choice as the index of its word. */
typedef struct law_option {
    const char *key;
    const char *choices; /* "printed|mindlin", first is the default; NULL for a number */
    double low, high, fallback;
    const char *doc;
} law_option;

#define LAW_OPTIONS_MAX 12
#define LAW_ARGUMENTS_MAX 8
#define LAW_PARAMETERS_MAX 12
#define LAW_PROPERTIES_MAX 8
#define LAW_FILES_MAX 3

typedef enum field_extent {
    PER_PARTICLE,
    PER_RECORD,
    PER_RECORD_BLOCK, /* of as many records as a work-group takes */
    PER_SCENE         /* faces of walls, prescribed motions: the host keeps them */
} field_extent;
typedef enum field_type {
    FIELD_REAL,  /* double, or float in mixed precision */
    FIELD_EXACT, /* 64 bits in either: what takes small increments over many steps, or what an overlap is a small difference of */
    FIELD_INT
} field_type;
typedef enum field_role {
    FIELD_STATE,   /* sorted with the particles, kept in checkpoints */
    FIELD_HISTORY, /* of a contact: carried over rebuilds by partner, kept in checkpoints, negated when a pair changes its owner */
    FIELD_RESULT   /* written anew in every step */
} field_role;

typedef struct field {
    const char *name; /* also the kernel argument's name */
    field_extent extent;
    field_type type;
    int components;
    field_role role;
    const char *unit, *doc;
} field;

/* What a law's `derive` reads: the two materials of a contact (b is NULL at a wall) and the resolved interaction values. */
struct scene;
typedef struct contact_class {
    const struct scene *scene;
    int stage; /* scene stage, whose changes count */
    int material_a;
    int material_b; /* -1: a rigid wall */
    int wall;       /* named wall, or -1 */
} contact_class;

typedef struct law {
    const char *name;
    slot_id slot;
    const char *doc;         /* one sentence */
    const char *source;      /* paper and equation */
    const char *kernel_file; /* below kernels/ */
    const char *more_files[LAW_FILES_MAX]; /* behind it, shared with other laws */
    law_option options[LAW_OPTIONS_MAX]; /* ends with a NULL key */
    const property *material_needs[LAW_PROPERTIES_MAX];
    const property *interaction_needs[LAW_PROPERTIES_MAX];
    const property *gas_needs[LAW_PROPERTIES_MAX]; /* of the environment */
    const field *pair_fields[LAW_ARGUMENTS_MAX];     /* what it adds to the pair stage's arguments, in this order */
    const field *particle_fields[LAW_ARGUMENTS_MAX]; /* what it adds to the particle stage's */
    /* Largest gap over which it acts on bodies in contact, for grains of that radius at most. NULL: none. */
    double (*reach)(const contact_class *class, double radius);
    /* True where its bonds hold at any distance, so that no new table may lose them. NULL: never. */
    bool (*keeps_bonds)(const double *option);
    bool turns; /* acts on spins, which must then be followed */
    bool reads_temperature; /* of the bodies of a contact */
    const char *parameters[LAW_PARAMETERS_MAX];      /* constants a contact class carries for it, in SI */
    /* Fills parameters for one contact class. `option` are this law's option values. */
    void (*derive)(const contact_class *class, const double *option, double *parameter);
    /* Rate at which it brakes any motion, 1/s: joins the limit of the step. NULL: none. */
    double (*drag_rate)(const double *option);
    /* Compile-time constants from the options: appends "#define NAME value" lines. May be NULL. */
    void (*constants)(const double *option, char *text, size_t size);
    /* The same from the whole scene: forms of a law that are cheaper where every contact allows them. May be NULL. */
    void (*scene_constants)(const struct scene *scene, char *text, size_t size);
    const char *grain_parameters[LAW_PARAMETERS_MAX]; /* constants that a grain's material carries for it, in SI */
    /* Fills them for one material in a scene stage. */
    void (*derive_grain)(const struct scene *scene, int stage, int material, const double *option, double *parameter);
} law;

/* Null-terminated list of every law that a scene may name. */
extern const law *const laws[];
const law *law_find(slot_id slot, const char *name);
const char *slot_name(slot_id slot);
/* The slot of that name, or SLOT_COUNT. */
slot_id slot_find(const char *name);
/* True when a scene may list the slot under `effects:`. */
bool slot_is_listed(slot_id slot);

/* May be a table against temperature. */
bool property_is_tabled(const property *property);
/* Every property that some law may read, each once; material or interaction scope. Null-terminated, owned by the library. */
const property *const *material_properties(void);
const property *const *interaction_properties(void);
/* What the environment's gas may give. */
const property *const *gas_properties(void);

#endif
