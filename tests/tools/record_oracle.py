"""What NumPy finds in a record: numbers for touch_record_test.cpp.

rows FILE     of each row t, hip, proxy, force, region, contact
facts FILE    rows, bytes of a row, number of the first and of the last tick, ticks in contact, checkpoints
"""

import sys

import numpy


def main():
    command, file = sys.argv[1:3]
    record = numpy.load(file, allow_pickle=False)
    mapped = numpy.load(file, mmap_mode="r", allow_pickle=False)
    assert record.shape == mapped.shape
    if command == "facts":
        tick = record["tick"]
        first, last = (int(tick[0]), int(tick[-1])) if len(tick) else (-1, -1)
        print(len(record), record.dtype.itemsize, first, last, int(record["contact"].sum()),
              int(record["checkpoint"].sum()))
        return
    for row in record:
        numbers = [row["t"], *row["hip"], *row["proxy"], *row["force"]]
        print(" ".join(float(x).hex() if numpy.isfinite(x) else "nan" for x in numbers),
              int(row["region"]), int(row["contact"]))


main()
