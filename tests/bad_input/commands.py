"""Bad command lines of every subcommand, and words that the one line they end in has to hold."""

POINT = ("--M", "200", "--L", "10", "--kappa", "0.5")
# Files of the folder that they are run in: `good` makes sound ones of each kind.
RECORD, OTHER, FILM, ELEMENT, STUDY = "record.h5", "other.h5", "film.h5", "element.json", "study.toml"
OIL = {"oil": "68", "temp": "50"}
BALL = ("--bearing", "6205", "--oil", "68", "--temp", "60", "--speed-rpm", "3000", "--load", "100")
ATLAS = ("atlas", "build", "-o", "new.h5")


def named(options):
    """Options by their names on a command line."""
    return {f"--{name.replace('_', '-')}": value for name, value in options.items()}


def at(command, *more, **changes):
    """A command at a point, with some of its options changed."""
    options = dict(zip(POINT[::2], POINT[1::2], strict=True)) | named(changes)
    return (command, *(part for pair in options.items() for part in pair), *more)


def steady(*more, **changes):
    return at("steady", *more, **changes)


def free(*more, **changes):
    return at("simulate", "--free", "5", *more, **changes)


def harmonic(*more, **changes):
    return at("simulate", "--harmonic", "3", *more, **changes)


def ball(command, *left_out, **changes):
    """A command at the contact of a bearing, with some of its options left out or changed."""
    options = dict(zip(BALL[::2], BALL[1::2], strict=True)) | named(changes)
    return (command, *(part for name, value in options.items() if name not in left_out for part in (name, value)))


def bearing(name, *more, **changes):
    """A bearing by its name, dry at 1000 N and 1000 rpm but for the changes."""
    options = named({"load": "1000", "speed_rpm": "1000"} | changes)
    return ("bearing", name, *(part for pair in options.items() for part in pair), *more)


COMMANDS = [
    # the program
    (("frobnicate",), ("frobnicate", "steady, simulate")),
    (("stedy", *POINT), ("stedy", "'steady'")),
    (("--verbose",), ("--verbose", "--version")),
    (("atlas", "bild"), ("bild", "'build'")),
    # init
    (("init", STUDY), ("FILE.toml = 'study.toml'", "a new file", "--force")),
    (("init", "new.txt"), ("FILE.toml = 'new.txt'", ".toml")),
    (("init", "new.toml", "--json", "new.toml"), ("--json = 'new.toml'", "another file", "for FILE.toml")),
    (("init", "new.toml", "--bearing", "6025"), ("--bearing = '6025'", "6205", "nearest")),
    (("init", "new.toml", "--oil", "68 cSt"), ("--oil = '68 cSt'", "ISO VG 10", "680")),
    (("init", "new.toml", "--temp", "323"), ("--temp = 323.0", "between 20 and 120")),
    (("init", "new.toml", "--speed-rpm", "nan"), ("--speed-rpm = nan", "finite")),
    (("init", "new.toml", "--bearing", "6999"), ("--bearing = '6999'", "6200 to 6211", "balls = ...")),
    (("init", "new.toml", "--load", "1e-3"), ("M", "between 0.1 and 60000")),
    (("init", "new.toml", "--load", "-5"), ("--load = -5.0", "between 1e-06")),
    (("init", "none/new.toml"), ("folder that exists",)),
    # a bearing's contact
    (("steady", *BALL[:-2]), ("--load = None", "given", "N")),
    (("steady", *BALL, "--M", "200"), ("--M = 200.0", "left out", "--bearing")),
    (("element", *BALL, "--contact", "cage"), ("--contact = 'cage'", "inner, outer")),
    (ball("steady", "--bearing"), ("--bearing = None", "given", "6205")),
    (ball("steady", "--oil"), ("--oil = None", "--oil and --temp, or --eta0 and --alpha")),
    (ball("steady", "--temp"), ("--temp = None", "--oil and --temp")),
    (ball("steady", "--speed-rpm"), ("--speed-rpm = None", "given", "rev/min")),
    (ball("steady", bearing="6999"), ("--bearing = '6999'", "6200 to 6211", "ehlcontact init")),
    (ball("steady", oil="olive"), ("--oil = 'olive'", "ISO VG 10, 15", "680")),
    (ball("steady", temp="300"), ("--temp = 300.0", "between 20 and 120")),
    (ball("steady", speed_rpm="-1"), ("--speed-rpm = -1.0", "between 0.001")),
    (ball("steady", speed_rpm="1e9"), ("--speed-rpm = 1000000000.0", "rev/min")),
    (ball("steady", load="0"), ("--load = 0.0", "between 1e-06")),
    (ball("steady", load="1e-5"), ("M of this contact", "between 0.1")),
    (ball("steady", load="1e6"), ("M of this contact", "20.1 GPa")),
    (ball("steady", contact="both"), ("--contact = 'both'", "inner, outer")),
    (ball("steady", eta0="0.04"), ("--oil = 68", "left out", "--eta0")),
    (ball("steady", "--oil", "--temp", eta0="0.04"), ("--alpha = None", "--eta0 and --alpha")),
    (ball("steady", "--oil", "--temp", eta0="40", alpha="2e-8"), ("--eta0 = 40.0", "mPa s")),
    (ball("steady", M="20"), ("--M = 20.0", "left out", "--bearing")),
    (steady("--load", "7"), ("--load = 7.0", "left out where --M")),
    (at("simulate", "--free-hz", "50"), ("--free-hz", "no unit of time")),
    (ball("simulate", free="5", **{"free-hz": "50"}), ("exactly one",)),
    (ball("simulate", amplitude="0.2", **{"free-hz": "5e3"}), ("--amplitude", "--harmonic")),
    (ball("simulate", **{"free-hz": "1e12"}), ("--free-hz", "between")),
    (ball("impedance", hz="50", Omega="1"), ("--hz", "one name", "left out", "--Omega")),
    (ball("impedance", hz="-50"), ("--hz", "-50")),
    (at("impedance"), ("--Omega = None", "2a/u_sum")),
    (ball("element", temp="20", oil="680", speed_rpm="20000"), ("L of this contact", "between 0 and 30")),
    *(
        (at(*command, option, "50"), (option, "--Omega", "2a/u_sum", "no unit of time"))
        for command in (("impedance",), ("element", "--model", "cubic"))
        for option in ("--hz", "--omega", "--rpm", "--speed-rpm")
    ),
    # steady, and what all solvers have in common
    *(
        (at(*command, **{option: value}), words)
        for command in (("steady",), ("simulate", "--free", "5.13"), ("impedance", "--Omega", "1"))
        for option, value, *words in (
            ("M", "1e9", "M = 1000000000.0", "between 0.1 and 60000"),
            ("M", "1e-3", "M = 0.001", "between 0.1 and"),
            ("M", "1e300", "M = 1e+300"),
            ("L", "1e9", "L = 1000000000.0", "between 0 and"),
            ("kappa", "20", "kappa = 20.0", "between 0.04 and 8"),
            ("kappa", "0.011", "kappa = 0.011"),
            ("alpha", "20", "alpha = 20.0", "in 1/GPa? then 2e-08 1/Pa"),
            ("alpha", "0.02", "alpha = 0.02", "in 1/MPa? then 2e-08 1/Pa"),
            ("alpha", "1e-300", "alpha = 1e-300"),
            ("eta0", "36.7", "eta0 = 36.7", "in mPa s? then 0.0367 Pa s"),
            ("eta0", "1e-4", "ln(eta/eta0)", "at most"),
        )
    ),
    *((steady(M=text), (f"--M = {float(text)}", "> 0")) for text in ("0", "-20", "nan", "inf")),
    *((steady(L=text), (f"--L = {float(text)}", ">= 0")) for text in ("-1", "nan")),
    *((steady(kappa=text), (f"--kappa = {float(text)}", "between 0.01 and 100")) for text in ("0", "1000")),
    *(
        (steady(alpha=text), (f"--alpha = {float(text)}", "between 1e-10 and 1e-06 1/Pa"))
        for text in ("0", "-1e-8")
    ),
    (steady(eta0="0"), ("--eta0 = 0.0",)),
    (steady(eta0="1e-6"), ("--eta0 = 1e-06", "between 0.0001 and 5 Pa s")),
    (steady(viscosity="honey"), ("--viscosity = 'honey'", "roelands")),
    (steady(density="lead"), ("--density = 'lead'", "dowson-higginson")),
    *(
        (steady(n=text), (f"--n = {text}", "multiple of 16 between 16 and 2048"))
        for text in ("100", "-64", "4096")
    ),
    (steady(M="30000", L="25", kappa="0.9"), ("Hertz pressure in GPa", "at most 5")),
    (steady("--domain", "-1", "1.5", "3"), ("--domain XA", "-1.0", "-1.2")),
    (steady("--domain", "-4", "1.5", "nan"), ("--domain YMAX", "nan", "finite")),
    (("steady",), ("--M = None", "given", "> 0")),
    (("steady", *POINT[:4]), ("--kappa", "given", "0.01 to 100")),
    (("steady", "--m", "200", *POINT[2:]), ("--m", "--M, --L, --kappa")),
    (steady("--grid", "64"), ("--grid", "--n, --domain")),
    (steady("--n"), ("--n", "one value", "multiple of 16")),
    (steady(n="sixty-four"), ("--n = 'sixty-four'", "whole number", "multiple of 16")),
    (steady(n="1e2"), ("--n = '1e2'", "whole number")),
    (steady(n="9" * 30), ("--n = 9999", "between 16 and 2048")),
    (steady(budget="0"), ("--budget = 0.0", "a finite number > 0")),
    (steady(threads="0"), ("--threads = 0", "whole number from 1 to", "cores that this process may use")),
    (steady(threads="9999"), ("--threads = 9999", "whole number from 1 to", "cores")),
    (steady(threads="all"), ("--threads = 'all'", "whole number")),
    (free(threads="9999"), ("--threads = 9999", "whole number from 1 to")),
    (at("impedance", "--Omega", "1", threads="0"), ("--threads = 0", "whole number from 1 to")),
    (steady("--n=x"), ("--n = 'x'", "whole number")),
    (steady("64"), ("64", "unexpected", "--help")),
    (steady(M=""), ("--M = ''", "a number")),
    (steady(M="2,000"), ("--M = '2,000'", "a number, as")),
    (steady(M="200N"), ("--M = '200N'", "a number, as")),
    (steady(M="0x10"), ("--M = '0x10'", "a number")),
    (steady(M="true"), ("--M = 'true'", "a number")),
    (steady(M="2e400"), ("--M = inf", "finite")),
    (steady(L="ten"), ("--L = 'ten'", "a number", ">= 0")),
    (steady(L="1e-320"), ("--L = 1e-320", "0, or between 1e-06 and 40")),
    (steady(L="-1e-9"), ("--L = -1e-09", ">= 0")),
    (steady(kappa="50%"), ("--kappa = '50%'", "0.01 to 100")),
    (steady(kappa="1/2"), ("--kappa = '1/2'", "a number")),
    (steady(alpha="2.2e8"), ("--alpha = 220000000.0", "between 1e-10 and 1e-06 1/Pa")),
    (steady(eta0="4e-5"), ("--eta0 = 4e-05", "between 0.0001 and 5 Pa s", "in m2/s? then 0.0348 Pa s")),
    (steady(eta0="nan"), ("--eta0 = nan", "finite", "between 0.0001 and 5 Pa s")),
    (steady(viscosity="Roelands"), ("--viscosity = 'Roelands'", "roelands, barus")),
    (steady(density="870"), ("--density = '870'", "dowson-higginson, incompressible")),
    (steady("--domain", "-4.5", "1.5"), ("--domain", "3 values", "XA XB YMAX")),
    (steady("--domain", "-4.5,1.5,3"), ("--domain", "3 values")),
    (steady("--domain", "4.5", "1.5", "3"), ("--domain XA = 4.5", "between -100 and -1.2")),
    (steady("--domain", "-4.5", "1", "3"), ("--domain XB = 1.0", "between 1.2 and 100")),
    (steady("--domain", "-4.5", "1.5", "300"), ("--domain YMAX = 300.0", "between 1.2 and 100")),
    (steady("--domain", "a", "b", "c"), ("--domain = 'a b c'", "a number", "XA XB YMAX")),
    (steady("--save", "r.txt"), ("--save = 'r.txt'", ".h5 or .hdf5")),
    (steady("--save", ""), ("--save", "file name")),
    (steady("--save", "none/r.h5"), ("--save = 'none/r.h5'", "folder that exists")),
    (steady("--save", f"{STUDY}/r.h5"), ("--save", "exists")),
    (steady("--save", "."), ("--save", "ending")),
    (steady("--save", "/proc/r.h5"), ("--save", "/proc/")),
    (steady("--json", "none/r.json"), ("--json", "none", "exists")),
    (steady("--json", f"{STUDY}/r.json"), ("--json", "exists")),
    (steady("--json", "/proc/r.json"), ("--json", "/proc/")),
    (steady("--figure", "f.gif"), ("--figure = 'f.gif'", ".png or .svg or .pdf")),
    (steady("--figure", "none/f.png"), ("--figure", "folder that exists")),
    (steady("--json", "."), ("--json = '.'", "a file, not a folder")),
    (steady("--save", RECORD, "--json", RECORD), ("--json = 'record.h5'", "another file", "for --save")),
    # simulate
    (at("simulate"), ("motion", "exactly one of --free, --harmonic, --ramp")),
    (at("simulate", "--free"), ("--free", "one value")),
    (at("simulate", "--free", "five"), ("--free = 'five'", "a number")),
    (at("simulate", "--free", "-5"), ("--free = -5.0", "> 0")),
    (at("simulate", "--free", "1e-300"), ("--free = 1e-300", "between 1e-06 and 1000", "rad/s or Hz")),
    (at("simulate", "--free", "314000"), ("--free = 314000.0", "between 1e-06 and 1000", "rad/s or Hz")),
    (at("simulate", "--harmonic", "1e9"), ("--harmonic = 1000000000.0", "between 1e-06 and 1000")),
    (at("simulate", "--harmonic", "0"), ("--harmonic = 0.0", "> 0")),
    (at("simulate", "--harmonic", "3", "--amplitude", "10"), ("--amplitude = 10.0", "above 0 and below 1")),
    (at("simulate", "--harmonic", "3", "--amplitude", "10%"), ("--amplitude = '10%'", "a number")),
    (at("simulate", "--harmonic", "3", "--Omega-n", "0"), ("--Omega-n = 0.0", "> 0")),
    (at("simulate", "--harmonic", "3", "--offset", "0.1"), ("--offset = 0.1", "left out", "--free")),
    (at("simulate", "--ramp", "3", "--Omega-n", "2"), ("--ramp", "DURATION")),
    (at("simulate", "--ramp", "3"), ("--ramp", "2 values", "RATIO DURATION")),
    (at("simulate", "--ramp", "3", "0", "--Omega-n", "2"), ("--ramp DURATION = 0.0", "> 0")),
    (at("simulate", "--ramp", "-3", "1", "--Omega-n", "2"), ("--ramp RATIO = -3.0", "> 0")),
    (free("--harmonic", "3"), ("motion", "exactly one")),
    (at("simulate", "--ramp", "3", "1"), ("--Omega-n", "--ramp")),
    (
        at("simulate", "--ramp", "1e4", "1", "--Omega-n", "2.4"),
        ("M under the largest load", "between 0.1 and 60000"),
    ),
    *((at("simulate", "--free", text), (f"--free = {float(text)}", "> 0")) for text in ("0", "nan")),
    (free("--amplitude", "0.2"), ("--amplitude", "0.2", "--harmonic")),
    (free("--Omega-n", "2"), ("--Omega-n", "2.0", "--harmonic or --ramp")),
    (harmonic("--rate", "0.1"), ("--rate", "0.1", "--free")),
    (harmonic("--start", "opening"), ("--start", "opening", "--free")),
    (free("--start", "up"), ("--start", "up", "closing, opening")),
    (harmonic("--amplitude", "1.5"), ("amplitude", "1.5", "below 1")),
    (harmonic("--until", "-1"), ("until", "-1.0", "> 0")),
    (harmonic("--dt", "nan"), ("dt", "nan", "> 0")),
    (harmonic("--until", "1", "--dt", "2"), ("--dt", "2.0", "until")),
    (harmonic("--local-error", "0"), ("error", "0.0", "> 0")),
    (harmonic("--local-error", "0.5"), ("error", "0.5", "0.1")),
    (harmonic("--checkpoint", "none/c.h5"), ("--checkpoint", "none/c.h5", "exists")),
    (harmonic("--restart", "none.h5"), ("restart", "none.h5", "checkpoint")),
    (free("--offset", "50"), ("--offset = 50.0", "between -2 and 2")),
    (free("--rate", "1e6"), ("--rate = 1000000.0", "within +-2 dry approaches")),
    (free("--until", "0"), ("--until = 0.0", "> 0")),
    (free("--until", "1e12"), ("--dt", "at least until/1 000 000")),
    (free("--until", "0.001", "--dt", "1"), ("--dt = 1.0", "at most until = 0.001")),
    (free("--dt", "1e-12"), ("--dt = 1e-12", "at least until/1 000 000")),
    (free("--local-error", "1e-30"), ("--local-error = 1e-30", "between 1e-08 and 0.1")),
    (free("--local-error", "5%"), ("--local-error = '5%'", "a number")),
    (free("--hz", "50"), ("--hz", "--free, --harmonic")),
    (free("--checkpoint", "c.txt"), ("--checkpoint = 'c.txt'", ".h5 or .hdf5")),
    (free("--restart", STUDY), ("restart = 'study.toml'", "checkpoint of `simulate`")),
    (free("--restart", RECORD), ("restart = 'record.h5'", "checkpoint of `simulate`")),
    (free("--restart", RECORD, "--save", RECORD), ("--save = 'record.h5'", "another file", "which is read")),
    (free("--checkpoint", OTHER, "--save", f"./{OTHER}"), ("--save", "another file", "for --checkpoint")),
    # impedance
    (at("impedance", "--Omega"), ("--Omega", "one value")),
    (at("impedance", "--Omega", "-1"), ("--Omega", "-1.0", "<= 200")),
    (at("impedance", "--Omega", "314000"), ("--Omega", "314000.0", "<= 200")),
    (at("impedance", "--Omega", "1", "--Omega", "x"), ("--Omega = '1, x'", "a number")),
    (at("impedance", "--Omega", "1,2,3"), ("--Omega = '1,2,3'", "a number")),
    (at("impedance", "--Omega", "1", "2"), ("(2)", "unexpected")),
    (at("impedance", "--Omega", "1", n="17"), ("--n = 17", "multiple of 16")),
    (at("impedance", "--Omega", "1", "--save", "z.h5"), ("--save", "--json")),
    (at("impedance", "--Omega", "1", "--json", "none/z.json"), ("--json", "folder that exists")),
    # fit
    (("fit",), ("R.h5", "given", "simulate")),
    (("fit", "none.h5"), ("file = 'none.h5'", "a readable result of simulate")),
    (
        ("fit", ELEMENT),
        ("file = 'element.json'", "result of simulate; its header names the class 'SpringContact'"),
    ),
    (("fit", FILM), ("file = 'film.h5'", "result of simulate; its header names the class 'SteadyResult'")),
    (("fit", RECORD, RECORD), ("file = 'record.h5'", "given once")),
    (("fit", RECORD, f"./{RECORD}"), ("given once", "record.h5")),
    (("fit", RECORD, OTHER), ("other.h5", "as in record.h5", "M 20")),
    (("fit", "r.h5", "--model", "quartic"), ("--model", "quartic", "linear")),
    (("fit", "r.h5", "--model", "memory", "--window", "1", "2"), ("--window", "memory")),
    (("fit", RECORD, "--model", "Cubic"), ("--model = 'Cubic'", "linear, cubic")),
    (("fit", RECORD, "--window", "1"), ("--window", "2 values", "START END")),
    (("fit", RECORD, "--window", "3", "1"), ("--window START = 3.0", "below end = 1.0")),
    (("fit", RECORD, "--window", "10", "20"), ("--window = (10.0, 20.0)", "samples of t in [0.0, 0.5]")),
    (("fit", RECORD, "--save", "e.h5"), ("--save = 'e.h5'", ".json")),
    (("fit", RECORD, "--json", RECORD), ("--json = 'record.h5'", "another file", "which is read")),
    (("fit", RECORD, "--save", "k.json", "--json", "k.json"), ("--json = 'k.json'", "for --save")),
    (("fit", RECORD, "--degree", "5"), ("--degree", "--model, --window")),
    # element
    (("element", *POINT[2:]), ("--M = None", "given")),
    (at("element", M="0.5"), ("--M = 0.5", "between 1 and 30000", "box of the atlas", "kappa 0.045..1")),
    (at("element", M="20000", L="25", kappa="0.9"), ("Hertz pressure", "4.1")),
    (at("element", "--model", "cubic", "--Omega", "1", M="6", L="19", kappa="0.11"), ("cubic", "wide")),
    (at("element", "--model", "wide", "--Omega", "1"), ("Omega", "left out", "wide")),
    (at("element", L="31"), ("--L = 31.0", "between 0 and 30")),
    (at("element", kappa="20"), ("--kappa = 20.0", "between 0.045 and 1")),
    (at("element", alpha="20"), ("--alpha = 20.0", "between 1e-10 and 1e-06 1/Pa", "in 1/GPa? then 2e-08")),
    (at("element", eta0="3"), ("--eta0 = 3.0", "between 0.002 and 1 Pa s", "in mPa s? then 0.003")),
    (at("element", viscosity="barus"), ("--viscosity = 'barus'", "roelands, the law of the atlas")),
    (at("element", density="incompressible"), ("--density", "dowson-higginson, the law of the atlas")),
    (at("element", "--model", "cubic"), ("--Omega = None", "given", "2a/u_sum")),
    (at("element", "--model", "cubic", "--Omega", "9999"), ("--Omega = 9999.0", ">= 0 and <= 60")),
    (at("element", "--model", "linear"), ("--model = 'linear'", "wide, cubic")),
    (at("element", "--atlas", "none.h5"), ("atlas = 'none.h5'", "readable table of an atlas")),
    (
        at("element", "--atlas", ELEMENT),
        ("atlas = 'element.json'", "table of an atlas; its header names the class 'SpringContact'"),
    ),
    (at("element", "--save", "e.txt"), ("--save = 'e.txt'", ".json")),
    (at("element", "--atlas", ELEMENT, "--json", ELEMENT), ("--json = 'element.json'", "which is read")),
    # export
    (("export", "-o", "new.fmu"), ("ELEMENT.json", "given")),
    (("export", ELEMENT), ("--output", "given", "FMU")),
    (("export", "none.json", "-o", "new.fmu"), ("file = 'none.json'", "readable contact element")),
    (
        ("export", RECORD, "-o", "new.fmu"),
        ("file = 'record.h5'", "contact element; its header names the class 'SimulationResult'"),
    ),
    (("export", STUDY, "-o", "x.fmu"), ("--output = 'x.fmu'", "new file", "--force")),
    (("export", STUDY, "-o", "new.fmu", "--contact", FILM), ("film.h5",)),
    (("explore",), ("--output", "given")),
    (("explore", "-o", "k.json"), ("--output = 'k.json'", ".html")),
    (("explore", "-o", "none/page.html"), ("--output = 'none/page.html'", "folder that exists")),
    (("export", ELEMENT, "-o", "x.zip"), ("--output = 'x.zip'", ".fmu")),
    (("export", ELEMENT, "-o", "none/x.fmu"), ("--output", "folder that exists")),
    (("export", ELEMENT, "-o", "new.fmu", "--fmi", "two"), ("--fmi = 'two'", "whole number")),
    (("export", "bearing.toml", "-o", "new.fmu"), ("bearing.toml", "readable TOML")),
    (("export", ELEMENT, "-o", "new.fmu", "--fmi", "1"), ("--fmi = 1", "must be 2 or 3")),
    (("export", ELEMENT, "-o", "new.fmu", "--name", ""), ("--name = ''", "1 to 100 printable characters")),
    (("export", ELEMENT, "-o", "new.fmu", "--json", ELEMENT), ("--json = 'element.json'", "which is read")),
    (("export", ELEMENT, "-o", "x.fmu"), ("--output = 'x.fmu'", "a new file", "--force")),
    (("export", ELEMENT, "-o", "new.fmu", "--platform", "win32"), ("--platform = 'win32'", "x86_64-linux", "all")),
    (("export", ELEMENT, "-o", "new.fmu", "--platform", "aarch64-linux"), ("--platform", "FMI 2 has no folder")),
    (("export", ELEMENT, "-o", "new.fmu", "--platform"), ("--platform", "one value")),
    (("export", ELEMENT, "-o", "x.fmu", "--overwrite"), ("--overwrite", "--force")),
    (("export", ELEMENT, ELEMENT, "-o", "new.fmu"), ("element.json", "unexpected")),
    # verify
    (("verify",), ("X.fmu", "given")),
    (("verify", "none.fmu"), ("file = 'none.fmu'", "a readable FMU", "No such file")),
    (("verify", "x.fmu"), ("file = 'x.fmu'", "a readable FMU", "not a zip file")),
    (("verify", ELEMENT), ("file = 'element.json'", "a readable FMU", "not a zip file")),
    (("verify", "."), ("file = '.'", "a readable FMU")),
    (("verify", "x.fmu", "--json", "x.fmu"), ("--json = 'x.fmu'", "which is read")),
    (("verify", "x.fmu", "element.json"), ("element.json", "unexpected")),
    (("verify", "x.fmu", "--element", ELEMENT), ("--element", "--json")),
    # validate and run
    (("validate",), ("STUDY.toml", "given")),
    (("validate", "none.toml"), ("study = 'none.toml'", "readable TOML file")),
    (("validate", RECORD), ("study = 'record.h5'", "TOML", "UTF-8")),
    (("validate", ELEMENT), ("study = 'element.json'", "complete TOML", "line 1")),
    (("validate", STUDY, "--jobs", "0"), ("--jobs = '0'", "whole number between 1 and 16")),
    (("validate", STUDY, "-o", RECORD), ("--output = 'record.h5'", "is a file")),
    (("validate", STUDY, "-o", 300 * "a"), ("--output = 'aaa", "at most 255 bytes")),
    (("validate", STUDY, "-o", "/".join(25 * [200 * "b"])), ("--output = 'bbb", "File name too long")),
    (("validate", STUDY, "-o", f"{RECORD}/out"), ("--output", "is a file")),
    (("validate", STUDY, "--json", STUDY), ("--json = 'study.toml'", "which is read")),
    (("run",), ("STUDY.toml", "given")),
    (("run", "."), ("study = '.'", "readable TOML file")),
    (("run", STUDY, "--jobs", "17"), ("--jobs = '17'", "between 1 and 16")),
    (("run", STUDY, "--threads", "9999"), ("--threads = 9999", "whole number from 1 to")),
    (("run", STUDY, "--threads", "0"), ("--threads = 0", "whole number from 1 to")),
    (("run", STUDY, "--jobs", "two"), ("--jobs = 'two'", "whole number")),
    (("run", STUDY, "-o", RECORD), ("--output = 'record.h5'", "folder")),
    (("run", STUDY, "-o", "/proc/out"), ("--output = '/proc/out'",)),
    (("run", STUDY, "-o", f"{RECORD}/out"), ("--output", "folder")),
    (("run", STUDY, "--json", STUDY), ("--json = 'study.toml'", "which is read")),
    (("run", STUDY, "--n", "64"), ("--n", "--output, --jobs")),
    # reproduce
    (("reproduce", "--table", "7"), ("--table = 7", "1, 2, 3, 4, 5, 6")),
    (("reproduce", "--table", "three"), ("--table = 'three'", "whole number", "1 to 6")),
    (("reproduce", "--figure", "3"), ("--figure = 3", "2, 4, 5")),
    (("reproduce", "--n", "48.5"), ("--n = '48.5'", "whole number")),
    (("reproduce", "--n", "0"), ("--n = 0", "between 16 and 2048")),
    (("reproduce", "-o", RECORD), ("--output = 'record.h5'", "folder")),
    # atlas build
    (("atlas", "build", "-o", "new.h5", "--draws", "1000000000"), ("--draws = 1000000000", "<= 10000000")),
    (("bearing", "6205", "--radial", "500", "--speed-rpm", "1e9"), ("--speed-rpm", "1e+06 rev/min")),
    (("validate", STUDY, "-o", "x" * 300), ("--output", "at most 255 bytes")),
    (("atlas", "build", "-o", "a.txt"), ("--output = 'a.txt'", ".h5")),
    (("atlas", "build", "-o", "none/a.h5"), ("--output", "folder that exists")),
    ((*ATLAS, "--draws", "many"), ("--draws = 'many'", "whole number")),
    ((*ATLAS, "--draws", "-1"), ("--draws = -1", "whole number >= 0")),
    ((*ATLAS, "--draws", "5", "--light-draws", "5"), ("points", "at least 20", "draws = 5")),
    ((*ATLAS, "--seed", "1.5"), ("--seed = '1.5'", "whole number")),
    ((*ATLAS, "--processes", "0"), ("--processes = 0", "whole number >= 1")),
    ((*ATLAS, "--processes", "100000000"), ("--processes = 100000000", "<= 1024")),
    ((*ATLAS, "--draws", "1000000000"), ("--draws = 1000000000", "<= 10000000")),
    ((*ATLAS, "--work", "new.h5"), ("--work = 'new.h5'", "another file", "for --output")),
    ((*ATLAS, "--work", STUDY), ("work folder = 'study.toml'", "a folder that can be written to", "File exists")),
    ((*ATLAS, "--scheduler", "nowhere"), ("--scheduler = 'nowhere'", "address of a Dask scheduler")),
    ((*ATLAS, "--scheduler", "tcp://127.0.0.1:1"), ("--scheduler", "refused")),
    ((*ATLAS, "--recipe", "fim"), ("--recipe = 'fim'", "film, supply, heat, waves")),
    # its other recipes
    *(
        ((*ATLAS[:2], "--recipe", recipe, "-o", *options), words)
        for recipe, things in (("heat", "contacts"), ("supply", "points"), ("waves", "points"))
        for options, words in (
            (("a.txt",), ("--output = 'a.txt'", ".h5")),
            (("new.h5", "--draws", "-1"), ("--draws = -1", "whole number >= 0")),
            (("new.h5", "--light-draws", "5"), ("--light-draws = 5", "left out", "draws, seed")),
            (("new.h5", "--draws", "5"), (things, "at least 20", "draws = 5")),
            (("new.h5", "--processes", "0"), ("--processes = 0", "whole number >= 1")),
        )
    ),
    # bearing
    (("bearing",), ("NAME|FILE.toml = None", "given")),
    (bearing(300 * "a"), ("bearing = 'aaa", "6000 to 6010")),
    (bearing("/".join(25 * [200 * "b"])), ("bearing = 'bbb", "6000 to 6010")),
    (bearing("6205", hz="1e30"), ("--hz = 1e+30", "between 0 and 1e+09")),
    (bearing("6025"), ("bearing = '6025'", "6205", "nearest", "examples/bearing_6205.toml")),
    (("bearing", "6205", "--speed-rpm", "1000"), ("--load = None", "given")),
    (("bearing", "6205", "--load", "1000"), ("--speed-rpm = None", "given")),
    (("bearing", "7205", "--pair", "back-to-back", "--preload", "300"), ("--speed-rpm = None", "given")),
    (bearing("6205", load="-5"), ("--load = -5.0", "0, or between 1e-06 and 1e+08 N")),
    (bearing("6205", load="1e6", **OIL), ("--load = 1000000.0", "a ball carries at most", "atlas")),
    (bearing("6205", load="0"), ("--load = 0.0", "preload the bearing")),
    (bearing("6205", speed_rpm="nan"), ("--speed-rpm = nan", "finite")),
    (bearing("6205", speed_rpm="0", **OIL), ("--speed-rpm = 0.0", "without rolling there is no film")),
    (bearing("6205", speed_rpm="90000", **OIL), ("--speed-rpm = 90000.0", "at most 21622")),
    (bearing("6205", oil="68"), ("--temp = None", "--oil and --temp")),
    (bearing("6205", oil="70", temp="50"), ("--oil = '70'", "ISO VG 10, 15")),
    (bearing("6205", oil="68", temp="323"), ("--temp = 323.0", "between 20 and 120")),
    (bearing("6205", clearance="5000"), ("--clearance = 5000", "between -397 and 397 um")),
    (bearing("6205", load="0", clearance="-300", **OIL), ("--clearance = -300", "a ball carries at most")),
    (bearing("6205", rq="0"), ("--rq = 0.0", "between 0.001 and 100")),
    (bearing("6205", figure="x.txt"), ("--figure = 'x.txt'", ".png")),
    (bearing("none.toml"), ("file = 'none.toml'", "readable TOML")),
    (bearing("6205", preload="5"), ("--preload = 5", "left out without --pair")),
    (bearing("6205", pair="back-to-back", axial="9"), ("--pair = 'back-to-back'", "need a contact angle")),
    (("bearing", "7205", "--speed-rpm", "0"), ("--axial = None", "an angular contact bearing")),
    (bearing("7205"), ("--axial = None", "an angular contact bearing, which carries")),
    (bearing("7502"), ("bearing = '7502'", "7205 A", "nearest")),
    (bearing("7205", axial="-200"), ("--load, --axial = (1000.0, -200.0)", "axial load in +z only")),
    (bearing("7205", axial="900", contact_angle="0.44"), ("--contact-angle = 0.44", "in rad? then 25.2")),
    (bearing("7205", axial="900", contact_angle="-15"), ("--contact-angle = -15.0", "between 1 and 45 degrees")),
    (bearing("7205", axial="900", contact_angle="50"), ("--contact-angle = 50.0", "between 1 and 45 degrees")),
    (bearing("7205", axial="900", clearance="20"), ("--clearance = 20", "left out beside a contact angle")),
    (bearing("7205", axial="900", clearance="CN"), ("--clearance", "left out beside a contact angle")),
    (bearing("7205", axial="900", race_control="both"), ("--race-control = 'both'", "outer, inner, shared")),
    (bearing("6205", contamination="1.2"), ("--contamination = 1.2", "above 0 and at most 1")),
    (bearing("6205", contamination="50"), ("--contamination = 50.0", "50 % is 0.5")),
    (bearing("6205", contamination="dirty"), ("--contamination = 'dirty'", "normal cleanliness")),
    (bearing("6205", reliability="0.95"), ("--reliability = 0.95", "between 90 and 99.95")),
    (bearing("7205", axial="900", tilt_x="1500"), ("--tilt-x = 1500.0", "between -100 and 100 mrad")),
    (bearing("7205", axial="900", tilt_x="1", moment_x="1"), ("--tilt-x = 1.0", "left out beside moments")),
    (bearing("7205", axial="900", speed_rpm="90000", **OIL), ("--speed-rpm = 90000.0", "where the atlas ends")),
    (("steady", "--axial", "5"), ("--axial", "not in the model", "ehlcontact bearing")),
    (ball("steady", bearing="7205"), ("--bearing = '7205'", "a deep-groove bearing here")),
]
