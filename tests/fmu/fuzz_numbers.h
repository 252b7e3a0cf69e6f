/* Random numbers of the random calls, the usual and the odd; include <math.h> before it. */
static unsigned long long seed = 1;

static unsigned int any(unsigned int count)
{
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (unsigned int)(seed >> 33) % count;
}

static double anything(double usual)
{
    static const double odd[] = {0.0, -1.0, 1e-300, 1e300, -1e300, 1e-6, 1e10, -1e10};
    switch (any(12)) {
    case 0: return NAN;
    case 1: return INFINITY;
    case 2:
    case 3: return odd[any(8)];
    default: return usual * (0.5 + (double)any(1000) / 1000.0);
    }
}

/* A value for a fixed parameter: about its start value, or odd now and then. */
static double parameter(double start)
{
    return any(8) ? start * (0.8 + (double)any(400) / 1000.0) : anything(start);
}
