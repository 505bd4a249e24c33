"""Problems whose answer is known without this package, one file a problem; `table.CASES` has all of them by name."""
