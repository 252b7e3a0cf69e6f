/* Bearings before their first step: as they start, at rest, and what their balls have there. */
#include "ball.h"

#include <math.h>
#include <string.h>

enum { MOST_SETTLINGS = 60 };       /* of heights: a handful */
static const double settled = 1e-9; /* of the largest height: by which heights at rest may still change */

/* Balls that have not been placed, films of the tables; surfaces are where they were. */
static void unmoved(const Bearing *b, double state[])
{
    BearingHead *head = (BearingHead *)(void *)state;
    const BearingSettings settings = head->settings;
    int k, race;
    memset(state, 0, shaft_place(b) * sizeof state[0]);
    head->settings = settings;
    head->angle = settings.cage_angle;
    for (k = 0; k < b->balls; k++) {
        Ball *ball = (Ball *)(void *)(state + HEAD_NUMBERS) + k;
        for (race = 0; race < 2; race++) {
            ball->factor[race][0] = ball->factor[race][1] = 1.0;
            ball->speed_sum[race][0] = ball->speed_sum[race][1] = 1.0;
        }
    }
}

const char *bearing_start(const Bearing *b, const BearingSettings *settings, double state[])
{
    const int oil = b->race[INNER_RACE].nodes > 0;
    if (!(fabs(settings->clearance) <= b->largest_place)) {
        return "clearance is too large or too small for a bearing of this size";
    }
    if (settings->film != 0.0 && !(settings->film == 1.0 && oil)) {
        return oil ? "film must be 0 (dry) or 1 (with oil films)" : "film must be 0: this bearing is dry";
    }
    memset(state, 0, bearing_state_size(b) * sizeof state[0]);
    ((BearingHead *)(void *)state)->settings = *settings;
    unmoved(b, state);
    return NULL;
}

const char *bearing_check(const Bearing *b, const double q[], double omega)
{
    return omega >= 0.0 ? bearing_within(b, q) : "speed must be >= 0 rad/s";
}

const char *bearing_within(const Bearing *b, const double q[])
{
    int j;
    for (j = 0; j < b->directions; j++) {
        if (!(fabs(q[j]) <= (b->direction[j] < TILT_X ? b->largest_place : b->largest_tilt))) {
            return "the inner ring is farther from the outer one than the groove of a race is deep "
                   "(a coupling with too long steps does that)";
        }
    }
    return NULL;
}

/* Looks heights up again under the loads of rest; returns whether they stay. */
static int settle_heights(const Bearing *b, double state[])
{
    double change = 0.0, most = 0.0;
    int k, race;
    for (k = 0; b->heights != NULL && b->heights->pages > 0 && k < b->balls; k++) {
        BallSurface *surface = (BallSurface *)(void *)(state + shaft_place(b) + 1) + k;
        const double psi = head_of(state)->angle + two_pi * k / b->balls;
        for (race = 0; race < 2; race++) {
            const double height = height_at(b, state, k, race, psi, state[shaft_place(b)], surface->angle);
            change = fmax(change, fabs(height - surface->height[race][0]));
            most = fmax(most, fabs(height));
            surface->height[race][0] = surface->height[race][1] = height;
        }
    }
    return change <= settled * most;
}

const char *bearing_rest(const Bearing *b, double state[], double work[], double omega, const double q[], double force[])
{
    return bearing_rest_at(b, state, work, omega, head_of(state)->settings.cage_angle, q, force);
}

const char *bearing_rest_at(const Bearing *b, double state[], double work[], double omega, double angle, const double q[],
                            double force[])
{
    static const double still[MOST_DIRECTIONS] = {0.0};
    const char *reason = NULL;
    int i;
    unmoved(b, state);
    ((BearingHead *)(void *)state)->angle = angle;
    for (i = 0; i < MOST_SETTLINGS && reason == NULL; i++) {
        bearing_begin(b, state, work, 0.0, omega);
        reason = bearing_press(b, state, work, q, still, force);
        if (reason == NULL) {
            bearing_accept(b, state, work);
            if (settle_heights(b, state)) {
                break;
            }
        }
    }
    return reason;
}

void bearing_describe(const Bearing *b, const double state[], double work[], BallAtRest balls[], double geometric[])
{
    Race races[2];
    int k, race;
    races_of(b, state, races);
    for (k = 0; k < b->balls; k++) {
        BallAtRest *at = &balls[k];
        double force[2], by_film[2], slopes[5][4];
        Search s;
        Pressed p;
        search_of(b, state, work, k, races, &s);
        press_ball(&s, s.ball->place, &p);
        for (race = 0; race < 2; race++) {
            const RaceForce *contact = race == INNER_RACE ? &p.inner : &p.outer;
            force[race] = at->load[race] = contact->force;
            by_film[race] = contact->by_film;
            at->angle[race] = atan2(p.at.sine[race], p.at.cosine[race]);
            at->approach[race] = p.at.l[race] - free_length(&s, race);
            at->compression[race] = fmax(0.0, contact->film);
            at->slope[race] = contact->stiffness;
            at->factor[race] = p.at.factor[race];
            at->speed_sum[race] = p.at.speed_sum[race];
        }
        at->orbit = p.at.orbit;
        at->rotation = p.at.rotation;
        at->axis = atan(p.at.axis);
        at->share = p.at.share;
        renew_slopes(&s, s.ball->place, force, by_film, slopes);
        memcpy(geometric + k * 20, slopes, sizeof slopes);
    }
}
