"""A report: a folder of pages, one of all ropes and one of each, with the files that they are made of."""
