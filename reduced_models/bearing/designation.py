"""Designations of bearings as makers print them and people type them: maker, name, suffixes.

"SKF 6205-2RS1/C3" is a 6205 with seals and the clearance class C3. Seals, shields, cages, greases and tolerance
classes do not change the balls; a suffix that is not listed here is reported as one that was not read. Roller
bearings and ball bearings of more than one row are recognised, so that a message names their kind.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

MAKERS = (
    "SKF", "FAG", "NSK", "NTN", "KOYO", "NACHI", "INA", "TIMKEN", "SNR", "GMN", "SNFA", "RHP", "MRC", "FAFNIR",
    "ZKL", "ZWZ", "HRB", "LYC", "PEER", "EZO", "NMB", "KBC", "FKL", "URB", "ORS", "ISB", "NKE", "BARDEN", "LDK",
)  # fmt: skip
SUFFIXES = {  # regular expression of a suffix: what it means
    r"C[1-5]|CN": "clearance class",
    r"[2-]?(RS[A-Z]?\d?|RZ|LL[A-Z]|DDU?|VV|NSE|NK|LU)": "seals",
    r"2?ZR?|ZZ[A-Z]?": "shields",
    r"P[0-6]A?|ABEC\d?": "tolerance class",
    r"TN\d*|TNH|TVP\d*|TVH|TB|M|MA|MB|J|JP|FM|Y|W": "cage",
    r"JEM|MT\d+|GJN|HT|LHT\d+|WT": "grease",
    r"NR?": "snap ring",
    r"K": "tapered bore",
    r"S[0-4]": "heat treatment of the rings",
    r"E|ETN\d*": "reinforced design: its balls may be others than those of the catalogue",
}
NOT_READ = "not read"
NOT_IN_TORQUE = {  # meaning of a suffix: what it adds to the torque that no model here has
    "seals": "drag of the seals and of the grease is not in the torque",
    "shields": "drag of the grease behind the shields is not in the torque",
}
GAP = r"[\s\-_/.,]"
TOKEN = r"(C[1-5](?!\d)|CN$)"  # a suffix that may follow another one without a separator
MAKER = re.compile(rf"^(?:{'|'.join(MAKERS)})(?={GAP}|\d){GAP}*")
# A name of the catalogue ends before a separator, a letter, or a number of seals or shields.
_END = rf"(?=$|{GAP}|[A-Z]|2[A-Z])"
_ANGLE_25 = r"(?!C(?!\d)|5)"  # 7205 AC and A5 have 25 degrees, 7205 A has 30
KINDS = {  # regular expression of a name without separators: the kind of the bearing
    r"(R?NU?|R?NJ|R?NUP|NUJ|NF|NH|NNU?|NCF|NNCF|NNF|SL)\d{2}": "cylindrical roller bearings",
    r"(R?NA|NKI?S?|HK|BK|HN|K|AXK)\d": "needle roller bearings",
    r"(213|222|223|230|231|232|238|239|240|241|248|249)\d\d(?!\d)": "spherical roller bearings",
    r"(302|303|313|320|322|323|329|330|331|332)\d\d(?!\d)|[HJL]M\d": "tapered roller bearings",
    r"C(2[23]|3[0129]|4[019]|5[09]|6[09])\d\d(?!\d)": "toroidal roller bearings",
    r"(811|812|874|893|894|292|293|294)\d\d(?!\d)": "roller thrust bearings",
    r"(511|512|513|514|522|523|524|532|533|534)\d\d(?!\d)": "thrust ball bearings",
    r"(12|13|22|23)\d\d(?!\d)": "self-aligning ball bearings of two rows",
    r"(32|33|52|53)\d\d(?!\d)": "angular contact ball bearings of two rows",
    r"(42|43)\d\d(?!\d)": "deep-groove ball bearings of two rows",
    r"QJ\d": "four-point contact ball bearings",
}


class Designation(NamedTuple):
    """A bearing's name as it was given, taken apart."""

    given: str
    name: str  # of the catalogue
    suffixes: tuple[tuple[str, str], ...] = ()  # each with its meaning

    @property
    def clearance(self) -> str | None:
        """Clearance class among the suffixes."""
        return next((suffix for suffix, meaning in self.suffixes if meaning == "clearance class"), None)

    @property
    def words(self) -> str:
        """Suffixes with their meanings, and what of them is not in the torque; empty where there are none."""
        parts = [f"{suffix}: {meaning}" for suffix, meaning in self.suffixes]
        return "; ".join(filter(None, [*parts, self.without_friction]))

    @property
    def without_friction(self) -> str:
        """What the name has that adds to the torque and is in no model here, in words; empty where nothing."""
        return next((text for _, meaning in self.suffixes if (text := NOT_IN_TORQUE.get(meaning))), "")


def squeezed(text: str) -> str:
    """A name in capitals without separators: 7205C, ER16K."""
    return re.sub(GAP, "", str(text).upper())


def designation(text: str, names: Iterable[str]) -> Designation | None:
    """Maker, name and suffixes of a bearing; None where no name of `names` is in it.

    Parameters
    ----------
    text : str
        As "SKF 6205-2RS1/C3".
    names : iterable of str
        Of a catalogue; where one begins with another, the longer one counts. An angular contact bearing without
        the letter of its angle is one of 30 degrees (A).
    """
    known = list(names)
    exact = {squeezed(name): name for name in known}
    written = str(text).strip().upper()
    rest = MAKER.sub("", written)
    for whole in (squeezed(written), squeezed(rest)):
        for spelled in (whole, f"{whole}A"):
            if spelled in exact:
                return Designation(str(text), exact[spelled])
    for pattern, name, without_letter in readings(known):
        if (found := re.match(pattern, rest)) is None:
            continue
        read = _with_suffixes(text, name, rest[found.end() :])
        # of 30 degrees without its letter: only before suffixes that are no letter of an angle
        unread = without_letter and read is not None and NOT_READ in dict(read.suffixes).values()
        return None if unread else read
    return None


def readings(names: Iterable[str]) -> list[tuple[str, str, bool]]:
    """Regular expressions of the beginning of a designation, in the order in which they count.

    Parameters
    ----------
    names : iterable of str
        Of a catalogue.

    Returns
    -------
    list of (str, str, bool)
        Expression, name that it stands for, and whether it leaves out the letter of an angle of 30 degrees.
    """
    known = list(names)
    whole = [(_pattern(name), name, False) for name in sorted(known, key=len, reverse=True)]
    return whole + [(_pattern(name[:-2]), name, True) for name in known if name.endswith(" A")]


def kind_of(text: str) -> str:
    """Kind of bearings that a name is of, where the library has none of them; else empty."""
    name = squeezed(MAKER.sub("", str(text).strip().upper()))
    return next((kind for pattern, kind in KINDS.items() if re.match(pattern, name)), "")


def _pattern(name: str) -> str:
    """Regular expression of a name with or without separators between its letters and digits."""
    if re.match(r"(S )?\d", name) is None:
        return r"(?!)"  # names of letters as UER204 have no suffixes
    parts = [re.escape(part) for part in re.findall(r"\d+|[A-Z]+", name)]
    return rf"^{f'{GAP}?'.join(parts)}{_ANGLE_25 if name.endswith(' A') else ''}{_END}"


def _with_suffixes(text: str, name: str, rest: str) -> Designation | None:
    """The designation; None where what follows the name are digits, of another bearing."""
    tokens = list(_tokens(rest))
    if any(token.isdigit() for token in tokens):
        return None
    return Designation(str(text), name, tuple((token, _meaning(token)) for token in tokens if token not in MAKERS))


def _tokens(rest: str) -> Iterator[str]:
    """Suffixes one by one: "ZZC3" is two."""
    for part in filter(None, re.split(GAP, rest)):
        yield from filter(None, re.split(TOKEN, part))


def _meaning(token: str) -> str:
    return next((words for pattern, words in SUFFIXES.items() if re.fullmatch(pattern, token)), NOT_READ)
