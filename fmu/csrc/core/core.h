/* An FMU without its FMI version: variables, call sequence, steps, derivatives, saved states. The interface of a version
 * adds names, logging and memory. A call that fails leaves the state as it was. */
#ifndef CORE_H
#define CORE_H

#include <stddef.h>

#include "model.h"

/* States of the call sequence; bits, so that a function can name those it may be called in. */
typedef enum {
    INSTANTIATED = 1,
    INITIALIZATION = 2,
    STEPPING = 4,    /* co-simulation */
    EVENT = 8,       /* model exchange; co-simulation with event mode */
    CONTINUOUS = 16, /* model exchange */
    TERMINATED = 32
} Phase;

enum {
    ANY_PHASE = INSTANTIATED | INITIALIZATION | STEPPING | EVENT | CONTINUOUS | TERMINATED,
    READABLE = INITIALIZATION | STEPPING | EVENT | CONTINUOUS | TERMINATED
};

typedef enum { CO_SIMULATION, MODEL_EXCHANGE } Kind;
typedef enum { REAL, BOOLEAN } Type;
typedef enum { INPUT, TUNABLE, FIXED, CONSTANT, STATE, DERIVATIVE, OUTPUT, MEASURE } Role;

/* One variable, by value reference: the generated variables.h has the table. */
typedef struct {
    Type type;
    Role role;
    double start, nominal;
} Variable;

static inline Fault refuse(const char *reason)
{
    return fault(REFUSE, reason);
}

static inline int count_bits(unsigned long long bits)
{
    int n = 0;
    for (; bits != 0; bits &= bits - 1) {
        n++;
    }
    return n;
}

static const char *const not_finite[N_INPUTS] = INPUTS_NOT_FINITE;
/* NULL of an input without a rate: */
static const char *const unlike_rate[N_INPUTS] = INPUTS_UNLIKE_RATES;
static const int force_on[N_INPUTS] = INPUT_FORCES; /* value references; -1: none, or of no rate */
static const char *const too_far[N_INPUTS] = INPUTS_TOO_FAR;

enum { STALE_LAW = 1, STALE_OUTPUTS = 2, STALE_RATES = 4, STALE_INPUTS = 8 }; /* what must be computed anew */

/* All of an instance that can change, without padding: its bytes are the serialized state. */
typedef struct {
    Model model;
    double time, stop_time, tolerance;
    double now[N_INPUTS];                /* the inputs at `time`, as far as the model has come */
    double given_time[2], given[2][N_INPUTS]; /* where the two last steps began, the later one first, and their inputs */
    double turn[N_INPUTS];               /* their slopes at `time`, for the derivatives of outputs */
    double input_slope[2][N_INPUTS];     /* first and second derivatives of the inputs, for the next step alone */
    unsigned long long slopes_set[2];    /* which of them were set: bit k is input k */
    unsigned long long contact, noticed; /* bits: contacts that push; bounds whose leaving has been logged */
    int phase, kind;
    int has_stop_time, n_given; /* n_given: steps in given, at most 2 */
    double missed[N_INPUTS], moved[N_INPUTS]; /* squares of what was missed of the changes of rates, and of these, in a block */
    double most_moved;                        /* of any rate in any block */
    double most_change;                       /* of any rate in a step */
    unsigned long long astray[N_INPUTS];      /* bits: of the last 64 steps, those that missed a rate by far */
    double apart[N_INPUTS], travelled[N_INPUTS]; /* squares of how far slopes of inputs and their rates are apart, and of both */
    double most_travelled, unlike[N_INPUTS]; /* unlike: blocks on end in which an input did not change as its rate */
    int stale, judged, compared, too_long;   /* judged, compared: steps in this block; too_long: blocks on end whose steps were */
    int far_astray;                          /* most of 32 steps missed a rate by far */
    int read_early;                          /* bits: outputs of inputs, without lead, were read after the last step, before it */
} State;

/* What saving a state keeps of it. */
typedef struct {
    unsigned long long identity; /* of the FMU, its FMI version and the kind of instance */
    State state;
    unsigned long long checksum;
} Saved;

void core_start(State *state, Kind kind);

/* Why a variable of this type may not be set now; FINE if it may. */
Fault core_may_set(const State *state, unsigned int reference, Type type, double value);

/* Sets variables of a type, all or none: a bad reference must not leave half of them set. */
Fault core_set(State *state, const unsigned int references[], size_t count, Type type, const double values[]);

/* Reads variables of a type, outputs after bringing them up to date. */
Fault core_get(State *state, const unsigned int references[], size_t count, Type type, double values[]);

/* Whether inputs are finite, and displacements ones that a machine has. */
Fault core_check_inputs(const double input[]);

/* Brings outputs, or outputs and derivatives of the states, up to date. */
Fault core_outputs(State *state);
Fault core_rates(State *state);

Fault core_setup(State *state, double start, int has_stop, double stop, int has_tolerance, double tolerance);
Fault core_exit_initialization(State *state);

/* One step of co-simulation; outputs then are those of its end, or of the time that `lead` says. */
Fault core_step(State *state, double time, double h);
int core_extrapolates(const State *state);  /* whether inputs go on beyond what was given */
int core_path_is_known(const State *state); /* whether a step can end early: its inputs are known within it */
Fault core_may_set_slope(const State *state, unsigned int reference, int order, double value);
void core_set_slope(State *state, unsigned int reference, int order, double value);

/* First time derivative of an output at the present time. */
Fault core_output_slope(State *state, unsigned int reference, double *value);

/* sum_j d(unknown_i)/d(known_j) seed_j for all i, or sum_i d(unknown_i)/d(known_j) seed_i for all j. */
Fault core_directional(State *state, const unsigned int unknowns[], size_t n_unknowns, const unsigned int knowns[],
                       size_t n_knowns, const double seed[], double sensitivity[]);
Fault core_adjoint(State *state, const unsigned int unknowns[], size_t n_unknowns, const unsigned int knowns[],
                   size_t n_knowns, const double seed[], double sensitivity[]);

/* Model exchange. `core_contact_changed` is true where the surfaces have met or parted since its last call. */
void core_set_states(State *state, const double states[]);
Fault core_set_time(State *state, double time);
Fault core_contact_changed(State *state, int *changed);
unsigned long long core_contact(const State *state); /* contacts that push, as bits; of an evaluated model */

/* What has been logged of steps: not part of the state, for a master that goes back is not told anew. */
typedef struct {
    int too_long, unlike;
} Told;

/* That steps are too long for the motion, or an input does not change as its rate says: each once, where it was so for some
 * time; NULL else. */
const char *core_step_warning(const State *state, Told *told);

/* Bounds of the validity box that have been left since the last call, in words written to `text`; NULL for none. */
const char *core_warning(State *state, char *text, size_t size);

void core_save(const State *state, const char *token, Saved *saved);
Fault core_load(State *state, const char *token, const Saved *saved);

extern const Variable core_variables[N_VARIABLES];

#endif
