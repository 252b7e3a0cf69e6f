"""The coarsest study: the whole chain in a few seconds."""

STUDY = """
[bearing]
balls = 9
ball_diameter_mm = 7.94
pitch_diameter_mm = 39.04
conformity = 0.52
radial_load = 20.0
speed_rpm = 3000.0
[oil]
eta0 = 0.02
alpha = 1e-8
[surface]
rq_ball_um = 0.02
rq_race_um = 0.15
[solver]
n = 32
n_transient = 32
[free]
steps_per_period = 20
[harmonic]
steps_per_period = 20
[rotor]
arrangement = "vertical"
disc_mass = 1.0
journal_mass = 0.1
shaft_stiffness = 5e7
shaft_damping = 10.0
disc_damping = 0.5
unbalance = 8e-6
revolutions = 2
steps_per_revolution = 20
decay_periods = 4
decay_steps_per_period = 20
fit_steps_per_period = 20
fit_amplitude = 0.1
[check]
half_step = true
[whole_bearing]
clearance_um = -1.0
revolutions = 10
steps_per_revolution = 200
"""
