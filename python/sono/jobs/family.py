"""One family of the atlas: its table, a row for each knot or link, and its ropes, in a folder."""

import io
import os
import re
import threading
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from sono import formats, tables
from sono.formats import FormatError
from sono.formats.files import make_folder
from sono.starts import archive
from sono.tables import Row

COLUMNS = (
    *("knot", "n", "dl", "l_p", "l_c", "l_a", "residual", "n_fine", "l_c_fine"),
    *("published", "source", "l_a_difference", "l_c_difference", "seed", "variant", "type"),
)


@dataclass
class Family:
    """The family `name` in a folder; files that are not there are empty."""

    folder: Path
    name: str
    lock: threading.Lock = field(default_factory=threading.Lock)

    @property
    def files(self) -> Sequence[str]:
        """Where its table and its ropes are."""
        return [str(self.folder / f"{self.name}.{suffix}") for suffix in ("tsv", "zip")]

    @cached_property
    def rows(self) -> dict[str, Row]:
        """The rows, by knot. Raises `FormatError`."""
        table = self.files[0]
        return {str(row["knot"]): row for row in tables.read(table)} if os.path.exists(table) else {}

    @cached_property
    def ropes(self) -> dict[str, bytes]:
        """The ropes, packed, by knot. Raises `FormatError`."""
        path = self.files[1]
        try:
            return archive.read(formats.load(path)[1]) if os.path.exists(path) else {}
        except zipfile.BadZipFile as error:
            raise FormatError(
                f"{path}: is no archive of ropes; remove it, or take it from a backup"
            ) from error

    def put(self, row: Row, rope: bytes) -> None:
        """Keep a knot's row and its rope. Raises `FormatError` where they cannot be written."""
        knot = str(row["knot"])
        with self.lock:
            make_folder(self.folder)
            self.rows[knot] = row
            if self.ropes.get(knot) != rope:
                self.ropes[knot] = rope
                formats.save(self.files[1], archive.written(dict(sorted(self.ropes.items(), key=_by_number))))
            text = io.StringIO()
            with tables.writer("tsv", COLUMNS, text) as table:
                for _, found in sorted(self.rows.items(), key=_by_number):
                    table.row(found)
            formats.save(self.files[0], text.getvalue())


def _by_number(item: tuple[str, object]) -> tuple[list[tuple[int, str]], str]:
    """Order 3_1, ..., 10_165, 11a_1, ..., 11n_185, 12a_1, and likewise links, sums and torus types."""
    knot = item[0]
    found = re.findall(r"(\d+)(\D*)", knot)
    return [(int(number), "" if sign == "_" else sign) for number, sign in found], knot
