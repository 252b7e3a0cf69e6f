/* A rotor whose contacts are not inside: their forces are inputs; see rotor.h. */
#include <string.h>

#include "rotor.h"

const char *contacts_start(Model *m)
{
    (void)m;
    return NULL;
}

const char *contacts_rest(Model *m, const double load[], double q[])
{
    (void)m, (void)load, (void)q;
    return NULL;
}

const char *contacts_evaluate(Model *m)
{
    (void)m;
    return NULL;
}

void contacts_carried(const double value[], double carried[])
{
    (void)value;
    memset(carried, 0, AXES * sizeof carried[0]);
}

const char *contacts_rates(Model *m)
{
    (void)m;
    return NULL;
}

void contacts_direction(const Model *m, const double seed[], double along[], double carried[])
{
    (void)m, (void)seed, (void)along, (void)carried;
}

const char *contacts_balance(Model *m, const Balance *balance, double h, double q[], double carried[])
{
    (void)m, (void)h;
    memcpy(q, balance->free, AXES * sizeof q[0]);
    memset(carried, 0, AXES * sizeof carried[0]);
    return NULL;
}

unsigned long long model_outside(const Model *m)
{
    (void)m;
    return 0;
}

void model_name_outside(const Model *m, unsigned long long which, char *text, size_t size)
{
    (void)m, (void)which, (void)text, (void)size;
}
