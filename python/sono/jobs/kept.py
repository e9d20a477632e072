"""Outputs that are there from an earlier run of the same job."""

import os

from sono.curve import forces
from sono.formats import FormatError, VertexFile
from sono.formats.ropefile import SETTLED, STUCK, TIGHT, figures
from sono.jobs import contacts, record
from sono.jobs.curvefiles import KEPT_RESIDUAL, rope_in
from sono.jobs.order import Order, judged, made_from, rope_row, shown, tolerance
from sono.jobs.result import Result
from sono.tightening.targets import Target, aimed


def kept_row(job: Order, file: VertexFile, n: Target) -> Result:
    """Give the row of an output that is there from an earlier run of the same job."""
    output = job.outputs[n]
    try:
        rope, measures, header = rope_in(output)
        if measures.n != aimed(n, measures.l_p):
            raise FormatError(f"{output}: has {measures.n} vertices, not {shown(n)}; move it away")
        if not header.figures:
            other = "says nothing of its rope, as NPY files cannot"
            raise FormatError(f"{output}: {other}; move it away, or --force starts anew")
        if not header.made or header.origin != made_from(job, file):
            other = "is of another curve, method or setting"
            raise FormatError(f"{output}: {other}; repeat those or move it away, or --force starts anew")
        if header.figures != figures(measures):
            raise FormatError(f"{output}: is not as it was written; move it away, or --force starts anew")
        if job.record:
            record.check(output)
        fitted = None if job.method == "sono" else forces(rope.components)
        if fitted and n in job.forces and not os.path.isfile(job.forces[n]):
            contacts.write(job.forces[n], rope.components, fitted)
    except FormatError as error:
        return Result(None, str(error))
    good = max(measures.dispersion, abs(1 - measures.r_s)) <= tolerance(job)
    if fitted is None:
        return judged(job, rope_row(job, output, measures, SETTLED if good else STUCK))
    # Only the run itself could tell that mu was reached; that it says so is checked as far as may be.
    good = good and header.status == TIGHT and fitted.residual <= KEPT_RESIDUAL
    row = rope_row(job, output, measures, TIGHT if good else STUCK, residual=fitted.residual)
    return judged(job, row)
