/* What gauss.h says of one kind of number. Included by gauss.c, once for each NUMBER with its SIZE
   and how its functions are called. */

/* the row from j on with the largest entry of column j */
static size_t CALLED(best)(const NUMBER *A, size_t rows, size_t columns, size_t j)
{
    size_t best = j;
    for (size_t i = j + 1; i < rows; i++)
        if (SIZE(A[i * columns + j]) > SIZE(A[best * columns + j]))
            best = i;
    return best;
}

void CALLED(rd_gauss_eliminate)(NUMBER *A, size_t rows, size_t columns, size_t own)
{
    for (size_t j = 0; j < own; j++) {
        NUMBER *pivot = A + j * columns, *other = A + CALLED(best)(A, rows, columns, j) * columns;
        for (size_t k = j; k < columns; k++) {
            const NUMBER first = pivot[k];
            pivot[k] = other[k];
            other[k] = first;
        }
        for (size_t i = j + 1; i < rows; i++) {
            NUMBER *row = A + i * columns;
            if (row[j] == 0)
                continue;
            const NUMBER share = row[j] / pivot[j];
            for (size_t k = j + 1; k < columns; k++)
                row[k] = LESS(row[k], share, pivot[k]);
        }
    }
}

void CALLED(rd_gauss_substitute)(const NUMBER *A, size_t columns, size_t own, size_t loads,
                                 NUMBER *x)
{
    for (size_t j = own; j-- > 0;)
        for (size_t load = 0; load < loads; load++) {
            const NUMBER found = x[j * loads + load] / A[j * columns + j];
            x[j * loads + load] = found;
            for (size_t i = 0; i < j; i++)
                x[i * loads + load] = LESS(x[i * loads + load], A[i * columns + j], found);
        }
}

#undef NUMBER
#undef SIZE
#undef CALLED
#undef LESS
