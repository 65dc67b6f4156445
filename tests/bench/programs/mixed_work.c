/* mixed_work.c - the kinds of work that the CoreMark benchmark consists of, in plain C: a linked
 * list that is searched, reversed and sorted through function pointers, a matrix, a state machine
 * over text, and a CRC that all of them end in. One round over 2000 bytes.
 * Written for this repository. Same amounts of the same work, so its three sums are CoreMark's
 * published ones for 2000 bytes: list E714H, matrix 1FD7H, states 8E3AH.
 * int may have 16 or 32 bits; results are left in mw_list_crc, mw_matrix_crc, mw_state_crc, mw_crc.
 */
typedef signed short s16;
typedef unsigned short u16;
typedef unsigned char u8;
#ifdef HOST
typedef signed int s32;
typedef unsigned int u32;
#else
typedef signed long s32;
typedef unsigned long u32;
#endif

#define PART_BYTES 666 /* a third of 2000 */
#define LIST_ITEMS (PART_BYTES / 20 - 2)
#define ORDER 9 /* of the matrix: two of u16 and one of u32 would just fit into PART_BYTES */
#define FINDS 0x66

u16 mw_list_crc, mw_matrix_crc, mw_state_crc, mw_crc;

/* -- CRC-16, reflected, bit by bit ------------------------------------------------------------- */

static u16 crc_byte(u8 data, u16 crc) {
    u8 i;
    for (i = 0; i < 8; i++) {
        u8 differ = (u8)((data ^ (u8)crc) & 1);
        data >>= 1;
        crc >>= 1;
        if (differ) crc ^= 0xA001;
    }
    return crc;
}

static u16 crc_word(u16 data, u16 crc) {
    crc = crc_byte((u8)data, crc);
    return crc_byte((u8)(data >> 8), crc);
}

static u16 crc_long(u32 data, u16 crc) {
    crc = crc_word((u16)data, crc);
    return crc_word((u16)(data >> 16), crc);
}

/* -- State machine: is a text between commas an integer, a decimal or a scientific number? ------ */

enum state { START, INVALID, SIGN, EXPONENT_MARK, INTEGER, DECIMAL, EXPONENT, SCIENTIFIC, STATES };

static u8 text[PART_BYTES];

static const char *const integers[4] = {"5012", "1234", "-874", "+122"};
static const char *const decimals[4] = {"35.54400", ".1234500", "-110.700", "+0.64400"};
static const char *const scientifics[4] = {"5.500e+3", "-.123e-2", "-87e+832", "+0.6e-12"};
static const char *const mistakes[4] = {"T0.3e-1F", "-T.T++Tq", "1T3.4e4z", "34.0e-T^"};

static void write_text(void) {
    u16 seed = 0;
    u16 used = 0;
    u16 size = 0;
    const char *piece = 0;
    while (used + size + 1 < PART_BYTES - 1) {
        u8 which;
        if (size > 0) {
            u16 i;
            for (i = 0; i < size; i++) text[used + i] = (u8)piece[i];
            text[used + size] = ',';
            used = (u16)(used + size + 1);
        }
        seed++;
        which = (u8)(seed >> 3 & 3);
        size = 8;
        switch (seed & 7) {
            case 0:
            case 1:
            case 2:
                piece = integers[which];
                size = 4;
                break;
            case 3:
            case 4:
                piece = decimals[which];
                break;
            case 5:
            case 6:
                piece = scientifics[which];
                break;
            default:
                piece = mistakes[which];
                break;
        }
    }
    while (used < PART_BYTES) text[used++] = 0;
}

static int is_digit(u8 symbol) {
    return symbol >= '0' && symbol <= '9';
}

static enum state scan(u8 **from, u32 *counts) {
    u8 *at = *from;
    enum state state = START;
    for (; *at && state != INVALID; at++) {
        u8 symbol = *at;
        if (symbol == ',') {
            at++;
            break;
        }
        switch (state) {
            case START:
                if (is_digit(symbol)) {
                    state = INTEGER;
                } else if (symbol == '+' || symbol == '-') {
                    state = SIGN;
                } else if (symbol == '.') {
                    state = DECIMAL;
                } else {
                    state = INVALID;
                    counts[INVALID]++;
                }
                counts[START]++;
                break;
            case SIGN:
                if (is_digit(symbol)) {
                    state = INTEGER;
                } else if (symbol == '.') {
                    state = DECIMAL;
                } else {
                    state = INVALID;
                }
                counts[SIGN]++;
                break;
            case INTEGER:
                if (symbol == '.') {
                    state = DECIMAL;
                    counts[INTEGER]++;
                } else if (!is_digit(symbol)) {
                    state = INVALID;
                    counts[INTEGER]++;
                }
                break;
            case DECIMAL:
                if (symbol == 'E' || symbol == 'e') {
                    state = EXPONENT_MARK;
                    counts[DECIMAL]++;
                } else if (!is_digit(symbol)) {
                    state = INVALID;
                    counts[DECIMAL]++;
                }
                break;
            case EXPONENT_MARK:
                state = symbol == '+' || symbol == '-' ? EXPONENT : INVALID;
                counts[EXPONENT_MARK]++;
                break;
            case EXPONENT:
                state = is_digit(symbol) ? SCIENTIFIC : INVALID;
                counts[EXPONENT]++;
                break;
            case SCIENTIFIC:
                if (!is_digit(symbol)) {
                    state = INVALID;
                    counts[INVALID]++;
                }
                break;
            default:
                break;
        }
    }
    *from = at;
    return state;
}

static void change_text(u8 by, u8 step) {
    u8 *at;
    for (at = text; at < text + PART_BYTES; at += step) {
        if (*at != ',') *at ^= by;
    }
}

static u16 work_on_text(u8 by, u8 step, u16 crc) {
    u32 ends[STATES];
    u32 counts[STATES];
    u8 i;
    u8 *at;
    for (i = 0; i < STATES; i++) ends[i] = counts[i] = 0;
    for (at = text; *at;) ends[scan(&at, counts)]++;
    change_text(by, step);
    for (at = text; *at;) ends[scan(&at, counts)]++;
    change_text(by, step);
    for (i = 0; i < STATES; i++) {
        crc = crc_long(ends[i], crc);
        crc = crc_long(counts[i], crc);
    }
    return crc;
}

/* -- Matrix ------------------------------------------------------------------------------------- */

static s16 left[ORDER * ORDER], right[ORDER * ORDER];
static s32 product[ORDER * ORDER];

static void fill_matrices(void) {
    s32 seed = 1;
    u16 i;
    for (i = 1; i <= ORDER * ORDER; i++) {
        s16 value;
        seed = (s32)i * seed % 65536;
        value = (s16)(seed + i);
        right[i - 1] = value;
        left[i - 1] = (s16)((value + (s16)i) & 0xFF);
    }
}

static void add_constant(s16 *a, s16 value) {
    u16 i, j;
    for (i = 0; i < ORDER; i++) {
        for (j = 0; j < ORDER; j++) a[i * ORDER + j] = (s16)(a[i * ORDER + j] + value);
    }
}

static void multiply_constant(s32 *c, const s16 *a, s16 value) {
    u16 i, j;
    for (i = 0; i < ORDER; i++) {
        for (j = 0; j < ORDER; j++) c[i * ORDER + j] = (s32)a[i * ORDER + j] * (s32)value;
    }
}

static void multiply_vector(s32 *c, const s16 *a, const s16 *b) {
    u16 i, j;
    for (i = 0; i < ORDER; i++) {
        c[i] = 0;
        for (j = 0; j < ORDER; j++) c[i] += (s32)a[i * ORDER + j] * (s32)b[j];
    }
}

static void multiply_matrix(s32 *c, const s16 *a, const s16 *b) {
    u16 i, j, k;
    for (i = 0; i < ORDER; i++) {
        for (j = 0; j < ORDER; j++) {
            c[i * ORDER + j] = 0;
            for (k = 0; k < ORDER; k++) {
                c[i * ORDER + j] += (s32)a[i * ORDER + k] * (s32)b[k * ORDER + j];
            }
        }
    }
}

#define BITS(x, from, count) (((x) >> (from)) & ~(0xFFFFFFFFUL << (count)))

static void multiply_bits(s32 *c, const s16 *a, const s16 *b) {
    u16 i, j, k;
    for (i = 0; i < ORDER; i++) {
        for (j = 0; j < ORDER; j++) {
            c[i * ORDER + j] = 0;
            for (k = 0; k < ORDER; k++) {
                s32 value = (s32)a[i * ORDER + k] * (s32)b[k * ORDER + j];
                c[i * ORDER + j] += (s32)(BITS(value, 2, 4) * BITS(value, 5, 7));
            }
        }
    }
}

static s16 matrix_sum(const s32 *c, s16 limit) {
    s32 sum = 0, before = 0, now;
    s16 result = 0;
    u16 i, j;
    for (i = 0; i < ORDER; i++) {
        for (j = 0; j < ORDER; j++) {
            now = c[i * ORDER + j];
            sum += now;
            if (sum > limit) {
                result += 10;
                sum = 0;
            } else {
                result += now > before ? 1 : 0;
            }
            before = now;
        }
    }
    return result;
}

static u16 work_on_matrices(s16 value, u16 crc) {
    const s16 limit = (s16)(0xF000 | value);
    u16 inner = 0;
    add_constant(left, value);
    multiply_constant(product, left, value);
    inner = crc_word((u16)matrix_sum(product, limit), inner);
    multiply_vector(product, left, right);
    inner = crc_word((u16)matrix_sum(product, limit), inner);
    multiply_matrix(product, left, right);
    inner = crc_word((u16)matrix_sum(product, limit), inner);
    multiply_bits(product, left, right);
    inner = crc_word((u16)matrix_sum(product, limit), inner);
    add_constant(left, (s16)-value);
    return crc_word(inner, crc);
}

/* -- Linked list -------------------------------------------------------------------------------- */

struct info {
    s16 data;
    s16 index;
};
struct item {
    struct item *next;
    struct info *info;
};
typedef s16 (*compare)(struct info *a, struct info *b, int complex);

static struct item items[LIST_ITEMS];
static struct info infos[LIST_ITEMS];

/* A value of an item's data, computed once: the low byte then keeps it. */
static s16 value_of(s16 *data) {
    s16 value = *data;
    u8 kind = (u8)(value & 7);
    s16 type = (s16)(value >> 3 & 0xF);
    if (value & 0x80) return (s16)(value & 0x7F);
    type = (s16)(type | type << 4);
    if (kind == 0) {
        value = (s16)work_on_text(0, (u8)(type < 0x22 ? 0x22 : type), mw_crc);
        if (mw_state_crc == 0) mw_state_crc = (u16)value;
    } else if (kind == 1) {
        value = (s16)work_on_matrices(type, mw_crc);
        if (mw_matrix_crc == 0) mw_matrix_crc = (u16)value;
    }
    mw_crc = crc_word((u16)value, mw_crc);
    value &= 0x7F;
    *data = (s16)((*data & 0xFF00) | 0x80 | value);
    return value;
}

static s16 by_value(struct info *a, struct info *b, int complex) {
    const s16 first = value_of(&a->data);
    (void)complex;
    return (s16)(first - value_of(&b->data));
}

static s16 by_index(struct info *a, struct info *b, int complex) {
    if (!complex) {
        a->data = (s16)((a->data & 0xFF00) | (a->data >> 8 & 0xFF));
        b->data = (s16)((b->data & 0xFF00) | (b->data >> 8 & 0xFF));
    }
    return (s16)(a->index - b->index);
}

/* Merge sort of runs of 1, 2, 4 ... items. */
static struct item *sort(struct item *list, compare order, int complex) {
    s16 run = 1;
    for (;;) {
        struct item *p = list;
        struct item *tail = 0;
        s16 merges = 0;
        list = 0;
        while (p) {
            struct item *q = p;
            s16 p_size = 0;
            s16 q_size = run;
            s16 i;
            merges++;
            for (i = 0; i < run; i++) {
                p_size++;
                q = q->next;
                if (!q) break;
            }
            while (p_size > 0 || (q_size > 0 && q)) {
                struct item *taken;
                if (p_size == 0 ||
                    (q_size != 0 && q && order(p->info, q->info, complex) > 0)) {
                    taken = q;
                    q = q->next;
                    q_size--;
                } else {
                    taken = p;
                    p = p->next;
                    p_size--;
                }
                if (tail) {
                    tail->next = taken;
                } else {
                    list = taken;
                }
                tail = taken;
            }
            p = q;
        }
        tail->next = 0;
        if (merges <= 1) return list;
        run = (s16)(run * 2);
    }
}

static struct item *find(struct item *list, const struct info *wanted) {
    if (wanted->index >= 0) {
        while (list && list->info->index != wanted->index) list = list->next;
    } else {
        while (list && (list->info->data & 0xFF) != wanted->data) list = list->next;
    }
    return list;
}

static struct item *reverse(struct item *list) {
    struct item *done = 0;
    while (list) {
        struct item *rest = list->next;
        list->next = done;
        done = list;
        list = rest;
    }
    return done;
}

static void exchange_infos(struct item *a, struct item *b) {
    struct info *kept = a->info;
    a->info = b->info;
    b->info = kept;
}

static u8 used_items;

static void insert_behind(struct item *place, s16 data, s16 index) {
    struct item *item = &items[used_items];
    if (used_items + 1 >= LIST_ITEMS) return;
    item->info = &infos[used_items++];
    item->info->data = data;
    item->info->index = index;
    item->next = place->next;
    place->next = item;
}

static struct item *make_list(void) {
    struct item *list = items;
    struct item *item;
    u16 i;
    list->next = 0;
    list->info = infos;
    list->info->index = 0;
    list->info->data = (s16)0x8080;
    used_items = 1;
    insert_behind(list, -1, 0x7FFF);
    for (i = 0; i < LIST_ITEMS; i++) {
        u16 byte = (u16)((i & 0xF) << 3 | (i & 7));
        insert_behind(list, (s16)(byte << 8 | byte), 0x7FFF);
    }
    i = 1;
    for (item = list->next; item->next; item = item->next) {
        if (i < LIST_ITEMS / 5) {
            item->info->index = (s16)i++;
        } else {
            u16 pattern = i++;
            item->info->index = (s16)(0x3FFF & ((i & 7) << 8 | pattern));
        }
    }
    return sort(list, by_index, 0);
}

static struct item *list;

static u16 work_on_list(s16 first_index) {
    u16 result = 0;
    u16 found = 0;
    u16 missed = 0;
    s16 i;
    struct info wanted;
    struct item *item;
    struct item *removed;
    wanted.index = first_index;
    for (i = 0; i < FINDS; i++) {
        wanted.data = (s16)(i & 0xFF);
        item = find(list, &wanted);
        list = reverse(list);
        if (!item) {
            missed++;
            result = (u16)(result + (list->next->info->data >> 8 & 1));
        } else {
            found++;
            if (item->info->data & 1) result = (u16)(result + (item->info->data >> 9 & 1));
            if (item->next) {
                struct item *behind = item->next;
                item->next = behind->next;
                behind->next = list->next;
                list->next = behind;
            }
        }
        if (wanted.index >= 0) wanted.index++;
    }
    result = (u16)(result + found * 4 - missed);
    if (first_index > 0) list = sort(list, by_value, 1);
    removed = list->next->next;
    exchange_infos(list->next, removed);
    list->next->next = removed->next;
    removed->next = 0;
    item = find(list, &wanted);
    if (!item) item = list->next;
    for (; item; item = item->next) result = crc_word((u16)list->info->data, result);
    exchange_infos(removed, list->next);
    removed->next = list->next->next;
    list->next->next = removed;
    list = sort(list, by_index, 0);
    for (item = list->next; item; item = item->next) {
        result = crc_word((u16)list->info->data, result);
    }
    return result;
}

int main(void) {
    u16 crc;
    write_text();
    fill_matrices();
    list = make_list();
    crc = work_on_list(1);
    mw_crc = crc_word(crc, mw_crc);
    crc = work_on_list(-1);
    mw_crc = crc_word(crc, mw_crc);
    mw_list_crc = mw_crc;
    return 0;
}
