"""The study file that ``ehlcontact init`` writes: every entry of the schema, explained, with the schema's default.

=========== ===============================================================================
module      responsibility
=========== ===============================================================================
``meaning`` what each entry of a study is, in words
``toml``    values, sections and files in TOML
``text``    the file: values, what they may be, defaults as comments; grids that suit the film
=========== ===============================================================================
"""
