"""The coarsest study: the whole chain in a few seconds; bearings alone, and a motor."""

BEARING = """balls = 9
ball_diameter_mm = 7.94
pitch_diameter_mm = 39.04
conformity = 0.52
"""
OIL = """[oil]
eta0 = 0.02
alpha = 1e-8
[surface]
rq_ball_um = 0.02
rq_race_um = 0.15
"""
CONTACT = """[contact]
n = 32
n_transient = 32
[contact.free]
steps_per_period = 20
[contact.harmonic]
steps_per_period = 20
[contact.rotor_band]
amplitude = 0.1
steps_per_period = 20
"""
MACHINE = f"""
[operation]
speed_rpm = 3000.0
{OIL}[shaft]
length_mm = 100.0
stiffness = 5e7
damping = 10.0
[[disc]]
position_mm = 50.0
mass = 1.0
unbalance = 8e-6
damping = 0.5
radial_load = 29.209
[[support]]
position_mm = 0.0
journal_mass = 0.05
clearance = -1.0
{BEARING}[[support]]
position_mm = 100.0
journal_mass = 0.05
clearance = -1.0
{BEARING}"""
FULL_FILMS = """[full_films]
arrangement = "vertical"
revolutions = 2
steps_per_revolution = 20
decay_periods = 4
decay_steps_per_period = 20
half_step = true
"""
IN_TIME = """[in_time]
revolutions = 10
steps_per_revolution = 200
"""
STUDY = MACHINE + CONTACT + FULL_FILMS + IN_TIME
# A bearing alone, which carries 20 N.
ALONE = f"""
[operation]
radial_load = 20.0
speed_rpm = 3000.0
{OIL}[[support]]
{BEARING}"""
# A bearing under axial load, a pair of them, and a motor.
ANGULAR = f"""[operation]
radial_load = 200.0
axial_load = 400.0
speed_rpm = 6000.0
{OIL}[[support]]
bearing = "7205"
"""
PAIR = ANGULAR.replace("400.0", "100.0") + 'pair = "back-to-back"\npreload = 200.0\ndistance_mm = 40.0\n'
MOTOR = """[operation]
speed_rpm = 15000.0
[oil]
iso_vg = 32
temperature = 80.0
[surface]
rq_um = 0.1
[shaft]
length_mm = 360.0
diameter_mm = 35.0
[[disc]]
position_mm = 180.0
diameter_mm = 110.0
width_mm = 120.0
unbalance = 1e-5
[[support]]
name = "drive end"
position_mm = 30.0
bearing = "6306"
clearance = "CN"
[[support]]
name = "fan end"
position_mm = 330.0
bearing = "6206"
clearance = "CN"
spring = 200.0
"""
# That of examples/small_study.toml, of its first bearing alone.
SMALL = """title = "6205 deep-groove ball bearing at light load, coarse grid"

[operation]
radial_load = 70.0               # N: M is about 210
speed_rpm = 3000.0

[[support]]
name = "6205"
balls = 9
ball_diameter_mm = 7.94
pitch_diameter_mm = 39.04
conformity = 0.52

[oil]
name = "ISO VG 68 mineral oil at 50 C"
eta0 = 0.0367
alpha = 2.0e-8

[contact]
race = "inner"
n = 64
n_transient = 64

[contact.free]
steps_per_period = 40

[contact.harmonic]
steps_per_period = 40
periods = 2

[contact.rotor_band]
amplitude = 0.1

[full_films]
arrangement = "vertical"
disc_mass = 1.5
journal_mass = 0.2
shaft_stiffness = 1e8
shaft_damping = 30.0
disc_damping = 1.0
unbalance = 2.0e-5
revolutions = 2
steps_per_revolution = 40
decay_periods = 6
decay_steps_per_period = 30
half_step = true
"""
