"""The picture of an FMU: where each version of FMI has it, of the size it asks for, always the same."""

import io
import zipfile

import pytest
from PIL import Image

from fmu import export_contact
from fmu.icon import SIZE, icon


@pytest.mark.parametrize(("fmi", "place"), [(2, "model.png"), (3, "terminalsAndIcons/icon.png")])
def test_icon_is_in_the_fmu(elements, tmp_path, fmi, place):
    path = export_contact(elements["cubic"], tmp_path / "x.fmu", fmi=fmi)
    with zipfile.ZipFile(path) as archive:
        assert archive.read(place) == icon()
        assert sum(name.endswith(".png") for name in archive.namelist()) == 1


def test_icon_is_small_and_can_be_read():
    """Ball above raceway with the film between, on nothing."""
    content = icon()
    icon.cache_clear()
    assert icon() == content and len(content) < 2000
    picture = Image.open(io.BytesIO(content))
    picture.load()  # checksums too
    assert picture.size == (SIZE, SIZE) and SIZE >= 100 and picture.mode == "RGBA"
    middle = [picture.getpixel((SIZE // 2, y)) for y in range(SIZE)]
    solid = [pixel for pixel in middle if pixel[3] == 255]
    assert list(dict.fromkeys(pixel for pixel in solid if solid.count(pixel) > 2)) == [
        (0x8D, 0x99, 0xA6, 255), (0xE0, 0x8A, 0x1E, 255), (0x4A, 0x55, 0x60, 255),
    ]  # fmt: skip
    assert picture.getpixel((0, 0))[3] == 0
