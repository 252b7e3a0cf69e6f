"""The study behind ``ehlcontact run``: a machine and its oil in, answers, elements, FMUs and report out.

=====================  ======================================================================================
module                 responsibility
=====================  ======================================================================================
``schema``             the study file: what may stand in it, and errors in one line
``sections``           its sections, but for the oil
``schema_errors``      those errors, and guesses at what was meant
``machine``            bearings, pairs and rotor made of its entries
``damper``             its squeeze film dampers
``parts``              these as calls of the library, and as lines of Python
``exports``            what other programs take: FMUs and scripts
``scripts``            the machine in Python, and in ROSS
``loads``              loads on the supports, the most loaded ball, and what is no machine
``answer``             state of the machine, K and C over frequency, and runs in time on models of its bearings
``forecast``           what a study will do, and its cost, without doing it
``stages``             the long computations, each a function of the study that leaves one file
``runner``             stages side by side, with progress, resume and Ctrl-C
``points``             its points, what is finished of each, and all of them together
``reduction``          fits and element files
``rotor``              the rotor on full films and on elements, turning with its unbalance and after a kick
``differences``        full films beside elements, and beside what there is without them
``oil_and_heat``       the study's bearing with these: table and CSV
``periodic``           the branch of [periodic] as a task of a run, its words, numbers and table
``defect``             a spall in a bearing: orders, and its force over time and as an envelope
``uncertain``          samples of a study with [uncertain]: draws, machines of them, batches as tasks of a run
``shared_entries``     pairs, moments and tilts, oil supply and heat: entries in terms of the library
``headline``           what was found, in one paragraph
``results``            everything in numbers: ``results.json``
``report``             ``report.html``
``bearing``            the bearing of a study for ``ehlcontact bearing``, and what its options change of it
=====================  ======================================================================================
"""
