"""Contact elements: force of one contact from its approach and rate, with or without a memory of the film.

| module | is responsible for |
|---|---|
| base | `ContactElement`: the interface of all elements; validity box, quality, source, units |
| validity | approach, rate, load and frequency that the data covered; the warning outside them |
| design_point | speed, oil and shape of the contact at which an element was fitted |
| spring | `SpringContact`: elements without memory: linear, cubic, polynomial, power |
| spring_law | compiled: spring, Hertz ends, damper and clipping in one law |
| jet | compiled: values with two partial derivatives |
| film_filters | compiled: the filters of the film memory over a step and in continuous time |
| film_law | compiled: a dry Hertz spring on a film with memory: a step, and the equations in continuous time |
| film_curve | static curve of a film law from a table of loads |
| film_response | the film law linearised about rest: impedance, state space; gains from an impedance, passivity |
| film_tables | coefficients of elements with a film memory: names by kind, checks, laws |
| film_contact | `FilmContact`: elements with a film memory: about one load, for every load, over the speed |
| film_speed | film laws over the speed; the speed at which the film in a contact was made, while it changes |
| motion_errors | error of wide-range elements by kind of motion, from full solves |
| element_summary | summary and figure of an element |

Heat and oil supply are in the tables from which elements are made: `reduced_models.atlas.heat`,
`reduced_models.atlas.supply` and `reduced_models.atlas.gain_fit`.

A new spring is a term of `spring_law.inside` and a kind in ``SpringContact.kinds``; ends, damper and clipping
follow, and the contract tests ask for an example of it. With another memory an element derives from
`base.ContactElement`, whose abstract methods say what rotors and oscillators need; it is a frozen dataclass,
registered by `ehlcontact.store.stored`.
"""
