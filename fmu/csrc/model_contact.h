/* Contact element: inputs and parameters, named as in reduced_models. Equations: README.md. */
#ifndef MODEL_CONTACT_H
#define MODEL_CONTACT_H

typedef struct {
    double approach; /* u, positive when the bodies come closer */
    double rate;     /* u' = du/dt */
    double K1, K2, K3;
    double C1;
    double low, high; /* validity interval of the approach */
} Model;

#endif
